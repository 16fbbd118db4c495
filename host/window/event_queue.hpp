// User input, on its way from the window's thread to the thread that renders.
#pragma once

#include <glm/glm.hpp>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <utility>

namespace glim {

// Positions are in pixels of the picture; (0, 0) is its upper left corner.
struct Event {
    enum class Kind { KeyDown, KeyUp, Move, ButtonDown, ButtonUp, Scroll, FocusLost, Resize, Drop, Close };
    Kind kind;  // Resize also if the picture may be gone, so that it is shown again, and if the display's scale is another
    std::chrono::steady_clock::time_point when;
    char key = 0;                // for KeyDown and KeyUp: an upper-case letter, a digit, a sign or kEscape
    glm::dvec2 position{0.0};    // of the mouse, for Move, ButtonDown, ButtonUp and Scroll
    int button = 0;              // for ButtonDown and ButtonUp: kLeftButton, kRightButton or kMiddleButton
    bool shift = false;          // for ButtonDown: whether the key is held
    double notches = 0.0;        // for Scroll: away from the user
    std::filesystem::path file;  // for Drop
};

inline constexpr int kLeftButton = 0, kRightButton = 1, kMiddleButton = 2;

inline constexpr char kEscape = 27, kFullScreen = 11;

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
