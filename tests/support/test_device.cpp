#include "tests/support/test_device.hpp"

namespace glim {

Device& testDevice()
{
    static const Instance instance;
    static Device device(instance);
    return device;
}

}  // namespace glim
