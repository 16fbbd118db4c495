// Records dispatches, times them, and submits them in portions.
#pragma once

#include "host/gpu/commands.hpp"

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace glim {

struct KernelStatistics {
    std::uint64_t dispatches = 0;
    double seconds = 0.0;  // on the device
};

class Recording {
public:
    // Adds the dispatches and device time of each kernel to `statistics`.
    Recording(const Device& device, std::map<std::string, KernelStatistics>& statistics);
    // The same, but asks `shouldContinue` (unless empty) after each portion of at most `dispatches`. Once it is false, nothing more runs.
    Recording(const Device& device, std::map<std::string, KernelStatistics>& statistics, std::uint32_t dispatches,
              std::function<bool()> shouldContinue);

    // The same, but calls `watch` after each dispatch with its kernel and push constants.
    using Watch = std::function<void(const Kernel&, std::span<const std::byte>)>;
    Recording(const Device& device, std::map<std::string, KernelStatistics>& statistics, Watch watch);

    // `groups` workgroups.
    template <class Push>
    void dispatch(const Kernel& kernel, const Bindings& bindings, const Push& push, std::uint32_t groups)
    {
        record(kernel, bindings, std::as_bytes(std::span<const Push, 1>(&push, 1)), groups);
    }
    // The group counts are read from `arguments` at `offset` bytes.
    template <class Push>
    void dispatchIndirect(const Kernel& kernel, const Bindings& bindings, const Push& push, const Buffer& arguments, std::uint64_t offset)
    {
        recordIndirect(kernel, bindings, std::as_bytes(std::span<const Push, 1>(&push, 1)), arguments, offset);
    }
    // The device writes `values` to the buffer, `offset` bytes from its start.
    template <class T>
    void write(const Buffer& buffer, std::uint64_t offset, std::span<const T> values)
    {
        if (Commands* commands = next()) {
            commands->write(buffer, offset, std::as_bytes(values));
        }
    }
    // The next dispatches, so many, run all or not at all.
    void keepTogether(std::uint32_t dispatches);
    // Lets the device run what is recorded while the host goes on. The next call is finish().
    void start();
    // Runs what has not run yet.
    void finish();

    // Whether anything may be missing because `shouldContinue` was false.
    bool isStopped() const { return stopped_; }
    // Seconds of what has run, by the device's clock; if it has none, by the host's, and the longest may be of several dispatches.
    double longest() const { return longest_; }
    double total() const { return total_; }

private:
    Commands* next();
    void record(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push, std::uint32_t groups);
    void recordIndirect(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push, const Buffer& arguments,
                        std::uint64_t offset);
    void showWatch(const Kernel& kernel, std::span<const std::byte> push);

    const Device& device_;
    std::map<std::string, KernelStatistics>& statistics_;
    std::uint32_t portion_;
    std::function<bool()> shouldContinue_;
    Watch watch_;
    bool stopped_ = false;
    std::optional<Commands> commands_;
    std::uint32_t recorded_ = 0, together_ = 0;
    double longest_ = 0.0, total_ = 0.0;
};

}  // namespace glim
