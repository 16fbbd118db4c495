#include "host/window/gestures.hpp"

#include <utility>

namespace glim {
namespace {

constexpr double kClickPixels = 3.0;  // a click becomes a drag if the mouse moves as far

}  // namespace

std::optional<Gesture> Gestures::take(const Event& event, bool isPanels)
{
    using Kind = Event::Kind;
    if (isPanels && !button_) {
        return std::nullopt;
    }
    if (event.kind == Kind::Scroll) {
        return Gesture{.kind = Gesture::Kind::Dolly, .notches = event.notches, .position = event.position};
    }
    if (event.kind == Kind::ButtonDown && !button_ && event.button != kRightButton) {
        button_ = event.button;
        pans_ = event.shift || event.button == kMiddleButton;
        dragged_ = false;
        from_ = event.position;
    } else if (event.kind == Kind::Move && button_) {
        dragged_ = dragged_ || glm::length(event.position - from_) >= kClickPixels;
        if (dragged_) {
            const glm::dvec2 motion = event.position - std::exchange(from_, event.position);
            return Gesture{.kind = pans_ ? Gesture::Kind::Pan : Gesture::Kind::Orbit, .motion = motion};
        }
    } else if (event.kind == Kind::ButtonUp && button_ == event.button) {
        button_.reset();
        if (!dragged_ && !pans_) {
            return Gesture{.kind = Gesture::Kind::Click, .position = event.position};
        }
    }
    return std::nullopt;
}

}  // namespace glim
