// User input, on its way from the window's thread to the thread that renders.
#pragma once

#include <glm/glm.hpp>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <utility>

namespace glim {

// Positions and motions are in pixels of the picture; (0, 0) is its upper left corner.
struct Event {
    enum class Kind { KeyDown, KeyUp, Orbit, Pan, Scroll, Click, Resize, Close };
    Kind kind;
    std::chrono::steady_clock::time_point when;
    char key = 0;              // for KeyDown and KeyUp: an upper-case letter, a digit, a sign or kEscape
    glm::dvec2 amount{0.0};    // for Orbit and Pan: the motion of the mouse; for Scroll: y notches away from the user
    glm::dvec2 position{0.0};  // for Click
};

inline constexpr char kEscape = 27;

class EventQueue {
public:
    void push(const Event& event)
    {
        {
            const std::lock_guard lock(mutex_);
            events_.push_back(event);
        }
        arrived_.notify_one();
    }

    // Takes all events out, the oldest first. Waits for the first one, but at most `seconds`.
    std::deque<Event> take(double seconds)
    {
        std::unique_lock lock(mutex_);
        if (seconds > 0.0) {
            arrived_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return !events_.empty(); });
        }
        return std::exchange(events_, {});
    }

    bool isEmpty() const
    {
        const std::lock_guard lock(mutex_);
        return events_.empty();
    }

private:
    mutable std::mutex mutex_;
    std::condition_variable arrived_;
    std::deque<Event> events_;
};

}  // namespace glim
