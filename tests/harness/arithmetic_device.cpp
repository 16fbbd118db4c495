#include "tests/harness/arithmetic_device.hpp"

#include "tests/harness/test_device.hpp"

#include <cstdlib>

namespace glim {

namespace {

// The variable has another value as long as this lives.
class Variable {
public:
    explicit Variable(const std::string& value)
    {
        const char* const before = std::getenv("GLIM_ARITHMETIC");
        kept_ = before == nullptr ? "" : before;
        setenv("GLIM_ARITHMETIC", value.c_str(), 1);
    }
    ~Variable() { setenv("GLIM_ARITHMETIC", kept_.c_str(), 1); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    std::string kept_;
};

}  // namespace

std::unique_ptr<Device> deviceWith(const std::string& arithmetic)
{
    testDevice();  // has the arithmetic of the process
    const Variable variable(arithmetic);
    return std::make_unique<Device>(testDevice().instance());
}

}  // namespace glim
