#include "tests/harness/test_device.hpp"

#include "harness_places.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

namespace glim {
namespace {

// A message of the validation layers fails the test that caused it, also one that came after the last submission. Tests after it fail once
// they submit.
class MessageWatch : public testing::EmptyTestEventListener {
public:
    explicit MessageWatch(const VulkanInstance& instance)
        : instance_(instance)
    {}
    void OnTestEnd(const testing::TestInfo&) override
    {
        try {
            instance_.refuseMessages();
        } catch (const DeviceError& error) {
            if (!hasComplained_) {
                ADD_FAILURE() << error.what();
            }
            hasComplained_ = true;
        }
    }

private:
    const VulkanInstance& instance_;
    bool hasComplained_ = false;
};

std::unique_ptr<Device> openDevice(const VulkanInstance& instance)
{
    const char* const chosen = std::getenv("GLIM_DEVICE");
    if (chosen == nullptr || *chosen == '\0') {
        return std::make_unique<Device>(instance);
    }
    try {
        return std::make_unique<Device>(instance, chosen);
    } catch (const InputError& error) {
        throw InputError(MessageId::UnknownName, {part::place("GLIM_DEVICE"), "=", part::value(chosen),
                                                  ": no such device; there are: ", part::expected(error.message().expected), "."});
    }
}

}  // namespace

Device& testDevice()
{
    [[maybe_unused]] static const int keptApart = setenv("GLIM_CACHE_DIR", HARNESS_CACHE, 1);  // from the user's
    static const VulkanInstance instance;
    static const std::unique_ptr<Device> device = openDevice(instance);
    [[maybe_unused]] static const bool watched = [] {
        testing::UnitTest::GetInstance()->listeners().Append(new MessageWatch(instance));
        return true;
    }();
    return *device;
}

}  // namespace glim
