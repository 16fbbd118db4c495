#include "tests/support/test_device.hpp"

namespace glim {

Device& testDevice()
{
    static const VulkanInstance instance;
    static Device device(instance);
    return device;
}

}  // namespace glim
