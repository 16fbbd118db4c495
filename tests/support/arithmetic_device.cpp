#include "tests/support/arithmetic_device.hpp"

#include "tests/support/test_device.hpp"

#include <cstdlib>

namespace glim {

std::unique_ptr<Device> deviceWith(const std::string& arithmetic)
{
    const char* const before = std::getenv("GLIM_ARITHMETIC");
    const std::string kept = before == nullptr ? "" : before;
    setenv("GLIM_ARITHMETIC", arithmetic.c_str(), 1);
    std::unique_ptr<Device> device = std::make_unique<Device>(testDevice().instance());
    setenv("GLIM_ARITHMETIC", kept.c_str(), 1);
    return device;
}

}  // namespace glim
