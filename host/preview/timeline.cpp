#include "host/preview/timeline.hpp"

#include "host/scene/load_gltf.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glim {

void Timeline::enter(const std::vector<Animation>& animations)
{
    const bool lasts = std::ranges::any_of(animations, [](const Animation& animation) { return animation.duration > 0.0; });
    animations_ = lasts ? animations : std::vector<Animation>();
    choices_.plays = choices_.plays && lasts;
    choices_.animation = findAnimation(animations_, moment_.animation).value_or(0);
    choices_.seconds = moment_.seconds;
}

void Timeline::choose(const TimeChoices& wanted, Time now)
{
    if (wanted.plays != choices_.plays) {
        toggle(now);
    }
    choices_.loops = wanted.loops;
    choices_.speed = wanted.speed;
    if (wanted.animation != choices_.animation) {
        choices_.animation = wanted.animation;
        moment_.animation = std::to_string(wanted.animation);
        setSeconds(0.0);
    } else if (wanted.seconds != choices_.seconds) {
        choices_.plays = false;
        setSeconds(wanted.seconds);
    }
}

void Timeline::toggle(Time now)
{
    choices_.plays = !choices_.plays;
    advanced_ = now;
    if (choices_.plays && moment_.seconds.value_or(duration()) >= duration()) {
        setSeconds(0.0);
    }
}

void Timeline::rest(const Moment& moment)
{
    moment_ = moment;
    choices_.plays = false;
    enter(std::exchange(animations_, {}));
}

void Timeline::advance(Time now)
{
    if (!choices_.plays) {
        return;
    }
    const double next = *moment_.seconds + static_cast<double>(choices_.speed) * secondsBetween(std::exchange(advanced_, now), now);
    const bool ends = next >= duration();
    choices_.plays = !ends || (choices_.loops && duration() > 0.0);
    setSeconds(!ends ? next : choices_.plays ? std::fmod(next, duration()) : duration());
}

Moment Timeline::shown() const
{
    return {animations_.size() > 1 ? std::to_string(choices_.animation) : moment_.animation, moment_.seconds};
}

void Timeline::setSeconds(std::optional<double> seconds) { moment_.seconds = choices_.seconds = seconds; }

}  // namespace glim
