// When pictures are presented, and how long inputs wait for them.
#pragma once

#include "host/clock.hpp"
#include "host/window/latency.hpp"

#include <vector>

namespace glim {

class Pacer {
public:
    using Time = Clock::time_point;

    // An input came at `time`, which a picture is to answer.
    void await(Time time);
    // Something is there to present.
    void change() { changed_ = true; }
    // A new picture begins. It answers the inputs so far.
    void begin();

    bool isChanged() const { return changed_; }
    // Whether the picture that began last has been presented.
    bool isShown() const { return shown_; }
    // Whether to present: at once if the user waits for an answer, otherwise in intervals that leave most of the time to rendering.
    bool isDue(Time now, bool isMoving) const;
    // Presenting took from `start` to `end`.
    void spend(Time start, Time end);
    // The picture was presented then. `isOld`: the camera has moved since it began, so that only the next one answers that.
    void show(bool isOld);

    const Latency& latency() const { return latency_; }

private:
    std::vector<Time> waiting_, underWay_;  // the inputs that no picture answers yet, and those that the next one answers
    bool changed_ = true, shown_ = true;
    Time presented_;
    double presentSeconds_ = 0.0;  // that presenting took last
    Latency latency_;
};

}  // namespace glim
