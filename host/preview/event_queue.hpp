// What the user does, from the window's thread to the one that renders.
#pragma once

#include <glm/glm.hpp>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>

namespace glim {

// Positions and ways in pixels of the picture, from its upper left corner.
struct Event {
    enum class Kind { KeyDown, KeyUp, Orbit, Pan, Scroll, Click, Resize, Close };
    Kind kind;
    std::chrono::steady_clock::time_point when;
    char key = 0;               // KeyDown, KeyUp: upper case; kEscape
    glm::dvec2 amount{0.0};     // Orbit, Pan: the way of the mouse; Scroll: y notches away from the user
    glm::dvec2 position{0.0};   // Click
};

inline constexpr char kEscape = 27;

class EventQueue {
public:
    void push(const Event& event);
    // Everything that has come, oldest first; waits at most `seconds` for the first.
    std::deque<Event> take(double seconds);
    bool isEmpty() const;

private:
    mutable std::mutex mutex_;
    std::condition_variable arrived_;
    std::deque<Event> events_;
};

}  // namespace glim
