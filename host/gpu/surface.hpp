// What a window shows pictures on.
#pragma once

#include "host/gpu/instance.hpp"

namespace glim {

class Surface {
public:
    // Takes over `handle`, of `instance`.
    Surface(const Instance& instance, VkSurfaceKHR handle) : instance_(instance), handle_(handle) {}
    ~Surface() { vkDestroySurfaceKHR(instance_.handle(), handle_, nullptr); }
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    VkSurfaceKHR handle() const { return handle_; }

private:
    const Instance& instance_;
    VkSurfaceKHR handle_;
};

}  // namespace glim
