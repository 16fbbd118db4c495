#include "host/gpu/device_class.hpp"

#include <cstddef>

namespace glim {

DeviceClass classify(VkPhysicalDeviceType type, VkDriverId driver)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return driver == VK_DRIVER_ID_MESA_LLVMPIPE ? DeviceClass::Llvmpipe : DeviceClass::Software;
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return DeviceClass::DiscreteGpu;
    default: return DeviceClass::SharedGpu;
    }
}

const ClassRules& rulesOf(DeviceClass deviceClass)
{
    static constexpr ClassRules kRules[] = {
        {.persistent = true, .compilesPaths = true, .pathCapacity = 1U << 18, .pathsPerThread = 16, .sharedStack = false},
        {.persistent = false, .compilesPaths = false, .pathCapacity = 1U << 18, .pathsPerThread = 16, .sharedStack = false},
        {.persistent = false, .compilesPaths = true, .pathCapacity = 1U << 20, .pathsPerThread = 2, .sharedStack = true},
        {.persistent = false, .compilesPaths = true, .pathCapacity = 1U << 24, .pathsPerThread = 1, .sharedStack = true},
    };
    return kRules[static_cast<std::size_t>(deviceClass)];
}

}  // namespace glim
