#include "host/preview/pacer.hpp"

#include <algorithm>
#include <utility>

namespace glim {
namespace {

constexpr double kFrameSeconds = 1.0 / 30.0, kMovingFrameSeconds = 1.0 / 60.0;
constexpr double kPresentShare = 0.1;  // the most of the time that presenting may take while nothing moves

}  // namespace

void Pacer::await(Time time)
{
    waiting_.push_back(time);
    changed_ = true;
}

void Pacer::begin()
{
    underWay_.insert(underWay_.end(), waiting_.begin(), waiting_.end());
    waiting_.clear();
    shown_ = false;
    changed_ = true;
}

bool Pacer::isDue(Time now, bool isMoving) const
{
    const double interval = isMoving ? kMovingFrameSeconds : std::max(kFrameSeconds, presentSeconds_ / kPresentShare);
    return !waiting_.empty() || !underWay_.empty() || secondsBetween(presented_, now) >= interval;
}

void Pacer::spend(Time start, Time end)
{
    presented_ = end;
    presentSeconds_ = secondsBetween(start, end);
}

void Pacer::show(bool isOld)
{
    if (!isOld) {
        begin();
    }
    changed_ = isOld;
    shown_ = true;
    for (const Time came : std::exchange(underWay_, {})) {
        latency_.add(secondsBetween(came, presented_));
    }
}

}  // namespace glim
