// The connection to Vulkan, and the messages of its validation layers.
#pragma once

#include "host/error.hpp"

#include <vulkan/vulkan.h>

#include <atomic>
#include <memory>
#include <vector>

namespace glim {

// Throws DeviceError "Vulkan could not <action>: <result>." unless `result` is a success. `action` is as in "create a buffer".
void check(VkResult result, const std::string& action);

bool contains(const std::vector<VkExtensionProperties>& extensions, const char* name);

// GLIM_VALIDATION=1 in the environment turns on the validation layers with their synchronization checks. Every message is printed
// to stderr and counted. If the layers are not installed, the constructor throws DeviceError: a check that does not run is no check.
class VulkanInstance {
public:
    // `extensions`: the instance extensions that a window needs.
    explicit VulkanInstance(const std::vector<const char*>& extensions = {});
    ~VulkanInstance();
    VulkanInstance(const VulkanInstance&) = delete;
    VulkanInstance& operator=(const VulkanInstance&) = delete;

    VkInstance handle() const { return handle_; }
    std::vector<VkPhysicalDevice> physicalDevices() const;

    // Throws DeviceError if the layers have printed a message since the start.
    void refuseMessages() const;

private:
    struct Nothing {};
    explicit VulkanInstance(Nothing);

    VkInstance handle_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    // The layers keep its address. It is atomic because kernels are compiled in several threads.
    std::unique_ptr<std::atomic<int>> messages_;
};

}  // namespace glim
