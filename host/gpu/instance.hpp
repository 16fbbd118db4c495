// The connection to Vulkan, and what it says against us.
#pragma once

#include "host/gpu/check.hpp"

#include <atomic>
#include <memory>
#include <vector>

namespace glim {

// With GLIM_VALIDATION=1 in the environment the validation and synchronization layers are on, and every message of theirs
// goes to stderr and is counted; without the layers installed that is a DeviceError, since a silent check is no check.
class Instance {
public:
    // With these extensions, which a window names.
    explicit Instance(const std::vector<const char*>& extensions = {});
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    VkInstance handle() const { return handle_; }
    std::vector<VkPhysicalDevice> physicalDevices() const;

    // Throws DeviceError once the layers have said anything.
    void refuseMessages() const;

private:
    VkInstance handle_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    std::unique_ptr<std::atomic<int>> messages_;  // an address that the layers may keep; kernels are compiled in several threads
};

}  // namespace glim
