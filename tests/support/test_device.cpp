#include "tests/support/test_device.hpp"

#include "places.h"

#include <gtest/gtest.h>

#include <cstdlib>

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

}  // namespace

Device& testDevice()
{
    [[maybe_unused]] static const int keptApart = setenv("GLIM_CACHE_DIR", GLIM_BUILD_DIR "/cache", 1);  // from the user's
    static const VulkanInstance instance;
    static Device device(instance);
    [[maybe_unused]] static const bool watched = [] {
        testing::UnitTest::GetInstance()->listeners().Append(new MessageWatch(instance));
        return true;
    }();
    return device;
}

}  // namespace glim
