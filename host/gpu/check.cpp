#include "host/gpu/check.hpp"

#include <vulkan/vulkan.hpp>

namespace glim {

void check(VkResult result, const std::string& action)
{
    if (result < 0) {
        throw DeviceError("Vulkan could not " + action + ": " + vk::to_string(static_cast<vk::Result>(result)) + ".");
    }
}

}  // namespace glim
