#include "host/preview/event_queue.hpp"

#include <utility>

namespace glim {

void EventQueue::push(const Event& event)
{
    {
        const std::lock_guard lock(mutex_);
        events_.push_back(event);
    }
    arrived_.notify_one();
}

std::deque<Event> EventQueue::take(double seconds)
{
    std::unique_lock lock(mutex_);
    if (seconds > 0.0) {
        arrived_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return !events_.empty(); });
    }
    return std::exchange(events_, {});
}

bool EventQueue::isEmpty() const
{
    const std::lock_guard lock(mutex_);
    return events_.empty();
}

}  // namespace glim
