#include "host/preview/guide_learner.hpp"

#include <chrono>
#include <utility>

namespace glim {
namespace {

constexpr std::chrono::milliseconds kBuilding(20);  // to wait while a guide is built, before input is looked at

}  // namespace

void GuideLearner::begin(const Renderer& renderer, const FlatScene& scene, const FlatCamera& camera)
{
    isItsTurn_ = needsDevice_ = isCancelled_ = isDone_ = false;
    const RenderSettings settings = renderer.settings();
    thread_ = std::thread([this, &renderer, &scene, camera, settings] {
        std::shared_ptr<const Guide> guide;
        std::exception_ptr error;
        try {
            if (pause(true)) {
                guide = learnGuide(renderer, scene, camera, settings, GuideUse::Always, [this](const LearningPause& now) {
                            return pause(now.needsDevice);
                        }).guide;
            }
        } catch (...) {
            error = std::current_exception();
        }
        const std::lock_guard lock(mutex_);
        guide_ = std::move(guide);
        error_ = error;
        isDone_ = true;
        isItsTurn_ = false;
        changed_.notify_all();
    });
}

// Called by the thread. If it is to end, it ends in its turn, since it then frees what it has on the device.
bool GuideLearner::pause(bool needsDevice)
{
    std::unique_lock lock(mutex_);
    if (!needsDevice && isCancelled_) {
        return false;
    }
    isItsTurn_ = false;
    needsDevice_ = needsDevice;
    changed_.notify_all();
    if (needsDevice) {
        changed_.wait(lock, [this] { return isItsTurn_; });
        needsDevice_ = false;
    }
    return !isCancelled_;
}

bool GuideLearner::advance()
{
    if (!isWorking()) {
        return false;
    }
    std::unique_lock lock(mutex_);
    if (!isCancelled_) {
        changed_.wait_for(lock, kBuilding, [this] { return needsDevice_ || isDone_; });
    }
    if (needsDevice_) {
        isItsTurn_ = true;
        changed_.notify_all();
        changed_.wait(lock, [this] { return !isItsTurn_; });
    }
    return !isCancelled_;
}

bool GuideLearner::isDone()
{
    const std::lock_guard lock(mutex_);
    return isDone_;
}

std::shared_ptr<const Guide> GuideLearner::take()
{
    if (!isWorking() || !isDone()) {
        return nullptr;
    }
    thread_.join();
    std::shared_ptr<const Guide> guide = std::exchange(guide_, nullptr);
    const std::exception_ptr error = std::exchange(error_, nullptr);
    if (isCancelled_) {
        return nullptr;
    }
    if (error) {
        std::rethrow_exception(error);
    }
    return guide;
}

void GuideLearner::cancel()
{
    const std::lock_guard lock(mutex_);
    isCancelled_ = true;
}

void GuideLearner::end()
{
    if (!isWorking()) {
        return;
    }
    cancel();
    while (!isDone()) {
        advance();
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return needsDevice_ || isDone_; });
    }
    take();
}

}  // namespace glim
