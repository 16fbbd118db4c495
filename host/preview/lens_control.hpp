// The lens, as the user opens and focuses it.
#pragma once

#include "host/flatten/flatten_scene.hpp"

#include <algorithm>

namespace glim {

// What the panel shows of the lens, and the user changes there.
struct LensChoices {
    float radius = 0.0F, focalDistance = 1.0F;  // metres
    bool focusesByClick = false;                // the next one

    bool operator==(const LensChoices&) const = default;
};

class LensControl {
public:
    static constexpr float kNearestFocus = 1e-6F, kFarthestFocus = 1e9F;  // metres, as of --focal-distance

    explicit LensControl(const Lens& first)
        : choices_{first.radius, first.focalDistance},
          isFocused_(first.radius > 0.0F)
    {}

    const LensChoices& choices() const { return choices_; }
    // A lens that is opened and was not focused yet is focused on what is `distance` metres ahead.
    void choose(const LensChoices& wanted, double distance)
    {
        choices_ = wanted;
        if (choices_.radius > 0.0F && !isFocused_) {
            focus(distance);
        }
    }
    void focus(double distance)
    {
        choices_.focalDistance = std::clamp(static_cast<float>(distance), kNearestFocus, kFarthestFocus);
        isFocused_ = true;
    }
    void setFocusesByClick(bool focuses) { choices_.focusesByClick = focuses; }
    // A pinhole is in focus at no distance of its own.
    Lens lens() const { return choices_.radius > 0.0F ? Lens{choices_.radius, choices_.focalDistance} : Lens(); }

private:
    LensChoices choices_;
    bool isFocused_;
};

}  // namespace glim
