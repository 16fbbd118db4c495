#include "host/render/recording.hpp"

#include "host/clock.hpp"

#include <algorithm>
#include <utility>

namespace glim {
namespace {

// Dispatches per portion if nobody is asked: all of them are timed, and a submission ends within seconds.
constexpr std::uint32_t kUnasked = 64;

}  // namespace

Recording::Recording(const Device& device, std::map<std::string, KernelStatistics>& statistics)
    : Recording(device, statistics, kUnasked, nullptr)
{}

Recording::Recording(const Device& device, std::map<std::string, KernelStatistics>& statistics, std::uint32_t dispatches,
                     std::function<bool()> shouldContinue)
    : device_(device),
      statistics_(statistics),
      portion_(shouldContinue ? dispatches : kUnasked),
      shouldContinue_(std::move(shouldContinue))
{}

Recording::Recording(const Device& device, std::map<std::string, KernelStatistics>& statistics, Watch watch)
    : Recording(device, statistics)
{
    watch_ = std::move(watch);
}

// The commands to record to; null once the recording is stopped.
Commands* Recording::next()
{
    if (recorded_ >= std::max(portion_, together_)) {
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

void Recording::record(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push, std::uint32_t groups)
{
    if (Commands* commands = next()) {
        commands->dispatch(kernel, bindings, push, groups);
        showWatch(kernel, push);
    }
}

void Recording::recordIndirect(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push, const Buffer& arguments,
                               std::uint64_t offset)
{
    if (Commands* commands = next()) {
        commands->dispatchIndirect(kernel, bindings, push, arguments, offset);
        showWatch(kernel, push);
    }
}

void Recording::showWatch(const Kernel& kernel, std::span<const std::byte> push)
{
    if (watch_) {
        finish();
        watch_(kernel, push);
    }
}

void Recording::keepTogether(std::uint32_t dispatches)
{
    if (recorded_ + dispatches > portion_) {
        finish();
    }
    together_ = recorded_ + dispatches;
}

void Recording::start()
{
    if (commands_) {
        commands_->submit();
    }
}

void Recording::finish()
{
    if (!commands_) {
        return;
    }
    const auto start = Clock::now();
    if (!commands_->isSubmitted()) {
        commands_->submit();
    }
    commands_->wait();
    const double waited = secondsSince(start);
    const std::vector<KernelTime> times = commands_->times();
    if (times.empty()) {  // the device has no clock: no dispatch took longer than all of them
        longest_ = std::max(longest_, waited);
        total_ += waited;
    }
    for (const KernelTime& time : times) {
        KernelStatistics& kernel = statistics_[time.kernel];
        ++kernel.dispatches;
        kernel.seconds += time.seconds;
        longest_ = std::max(longest_, time.seconds);
        total_ += time.seconds;
    }
    commands_.reset();
    recorded_ = together_ = 0;
    stopped_ = shouldContinue_ && !shouldContinue_();
}

}  // namespace glim
