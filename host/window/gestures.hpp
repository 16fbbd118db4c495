// What the mouse asks for.
#pragma once

#include "host/window/event_queue.hpp"

#include <optional>

namespace glim {

// Positions and motions are in pixels of the picture.
struct Gesture {
    enum class Kind { Orbit, Pan, Dolly, Click };
    Kind kind;
    glm::dvec2 motion{0.0};    // of the mouse, for Orbit and Pan
    double notches = 0.0;      // for Dolly
    glm::dvec2 position{0.0};  // for Dolly and Click
};

// Tells clicks from drags.
class Gestures {
public:
    // Returns what the event asks for. `isPanels`: a panel has the mouse, and only a gesture that has begun beside it goes on.
    std::optional<Gesture> take(const Event& event, bool isPanels);
    // Forgets the button that is down.
    void cancel() { button_.reset(); }

private:
    std::optional<int> button_;  // the button that is down
    bool pans_ = false, dragged_ = false;
    glm::dvec2 from_{0.0};  // where it went down, or where the mouse was last in a drag
};

}  // namespace glim
