// The time of the animation, which plays or is chosen by the user.
#pragma once

#include "host/clock.hpp"
#include "host/preview/moment.hpp"
#include "host/scene/scene.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace glim {

// What the panel shows of the time, and the user changes there.
struct TimeChoices {
    std::size_t animation = 0;
    std::optional<double> seconds;  // absent: the rest pose
    bool plays = false, loops = true;
    float speed = 1.0F;  // seconds of the animation a second

    bool operator==(const TimeChoices&) const = default;
};

class Timeline {
public:
    using Time = Clock::time_point;

    explicit Timeline(const Moment& first)
        : moment_(first)
    {}

    // Takes the animations of a scene, also when it has been loaded again.
    void enter(const std::vector<Animation>& animations);
    // Without an animation that lasts there is nothing to play.
    bool isEmpty() const { return animations_.empty(); }
    const std::vector<Animation>& animations() const { return animations_; }
    const Moment& moment() const { return moment_; }
    bool isPlaying() const { return choices_.plays; }
    TimeChoices choices() const { return choices_; }

    // Takes what the user wants. A time that is chosen ends the playing. It begins again from the start where the animation has ended.
    void choose(const TimeChoices& wanted, Time now);
    // Plays, or rests.
    void toggle(Time now);
    // Rests at that time.
    void rest(const Moment& moment);
    // Plays from the time of the last call until `now`.
    void advance(Time now);
    // The same with the animation's index, if there are several.
    Moment shown() const;

private:
    double duration() const { return animations_[choices_.animation].duration; }
    void setSeconds(std::optional<double> seconds);

    std::vector<Animation> animations_;
    Moment moment_;
    TimeChoices choices_;
    Time advanced_;
};

}  // namespace glim
