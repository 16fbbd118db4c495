// Turns a VkResult into a sentence.
#pragma once

#include "host/error.hpp"

#include <vulkan/vulkan.h>

namespace glim {

// Throws DeviceError "<action>: <result>" unless `result` is a success; `action` is what was tried, as in "create buffer".
void check(VkResult result, const std::string& action);

}  // namespace glim
