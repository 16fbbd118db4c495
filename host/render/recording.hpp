// Dispatches one after the other, timed, and submitted in portions.
#pragma once

#include "host/gpu/commands.hpp"
#include "shaders/shared/path_types.h"

#include <functional>
#include <map>
#include <optional>
#include <string>

namespace glim {

struct KernelStatistics {
    std::uint64_t dispatches = 0;
    double seconds = 0.0;  // on the device
};

class Recording {
public:
    // Adds what each kernel took to `statistics`.
    Recording(const Device& device, std::map<std::string, KernelStatistics>& statistics);
    // And asks `goesOn`, unless that is empty, whenever a portion of `dispatches`, or less, has run; once it is false, nothing more runs.
    Recording(const Device& device, std::map<std::string, KernelStatistics>& statistics, std::uint32_t dispatches,
              std::function<bool()> goesOn);

    // And calls `watch` after each dispatch with what it was.
    Recording(const Device& device, std::map<std::string, KernelStatistics>& statistics,
              std::function<void(const Kernel&, const Pass&)> watch);

    // `groups` workgroups.
    void dispatch(const Kernel& kernel, const Bindings& bindings, const Pass& pass, std::uint32_t groups);
    // The group counts are read from `arguments` at `offset` bytes.
    void dispatchIndirect(const Kernel& kernel, const Bindings& bindings, const Pass& pass, const Buffer& arguments,
                          std::uint64_t offset);
    // Runs what has not run yet; must end a recording.
    void finish();

    // Whether anything may be missing because `goesOn` was false.
    bool isStopped() const { return stopped_; }
    // Device seconds of what has run.
    double longest() const { return longest_; }
    double total() const { return total_; }

private:
    Commands* next();
    void showWatch(const Kernel& kernel, const Pass& pass);

    const Device& device_;
    std::map<std::string, KernelStatistics>& statistics_;
    std::uint32_t portion_;
    std::function<bool()> goesOn_;
    std::function<void(const Kernel&, const Pass&)> watch_;
    bool stopped_ = false;
    std::optional<Commands> commands_;
    std::uint32_t recorded_ = 0;
    double longest_ = 0.0, total_ = 0.0;
};

}  // namespace glim
