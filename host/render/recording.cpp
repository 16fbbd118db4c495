#include "host/render/recording.hpp"

#include <algorithm>
#include <utility>

namespace glim {
namespace {

// Dispatches of a portion where nobody is asked: all of them are timed, and a submission ends within seconds.
constexpr std::uint32_t kUnasked = 64;

std::span<const std::byte> bytesOf(const Pass& pass) { return std::as_bytes(std::span<const Pass, 1>(&pass, 1)); }

}  // namespace

Recording::Recording(const Device& device, std::map<std::string, KernelStatistics>& statistics)
    : Recording(device, statistics, kUnasked, nullptr)
{
}

Recording::Recording(const Device& device, std::map<std::string, KernelStatistics>& statistics, std::uint32_t dispatches,
                     std::function<bool()> goesOn)
    : device_(device), statistics_(statistics), portion_(goesOn ? dispatches : kUnasked), goesOn_(std::move(goesOn))
{
}

Recording::Recording(const Device& device, std::map<std::string, KernelStatistics>& statistics,
                     std::function<void(const Kernel&, const Pass&)> watch)
    : Recording(device, statistics)
{
    watch_ = std::move(watch);
}

// Null once it is stopped.
Commands* Recording::next()
{
    if (recorded_ == portion_) {
        finish();
    }
    if (stopped_) {
        return nullptr;
    }
    if (!commands_) {
        commands_.emplace(device_);
    }
    ++recorded_;
    return &*commands_;
}

void Recording::dispatch(const Kernel& kernel, const Bindings& bindings, const Pass& pass, std::uint32_t groups)
{
    if (Commands* commands = next()) {
        commands->dispatch(kernel, bindings, bytesOf(pass), groups);
        showWatch(kernel, pass);
    }
}

void Recording::dispatchIndirect(const Kernel& kernel, const Bindings& bindings, const Pass& pass, const Buffer& arguments,
                                 std::uint64_t offset)
{
    if (Commands* commands = next()) {
        commands->dispatchIndirect(kernel, bindings, bytesOf(pass), arguments, offset);
        showWatch(kernel, pass);
    }
}

void Recording::showWatch(const Kernel& kernel, const Pass& pass)
{
    if (watch_) {
        finish();
        watch_(kernel, pass);
    }
}

void Recording::finish()
{
    if (!commands_) {
        return;
    }
    commands_->submitAndWait();
    for (const KernelTime& time : commands_->times()) {
        KernelStatistics& kernel = statistics_[time.kernel];
        ++kernel.dispatches;
        kernel.seconds += time.seconds;
        longest_ = std::max(longest_, time.seconds);
        total_ += time.seconds;
    }
    commands_.reset();
    recorded_ = 0;
    stopped_ = goesOn_ && !goesOn_();
}

}  // namespace glim
