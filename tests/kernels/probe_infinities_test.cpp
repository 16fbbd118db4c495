// The question whether a device keeps infinities (shaders/kernels/probe_infinities.comp). A device that keeps them gives all answers;
// numbers that stand for lost ones take their answers away, and each that is missing is refused.
#include "host/render/check_infinities.hpp"

#include "tests/harness/test_device.hpp"
#include "tests/support/expect_message.hpp"

#include <gtest/gtest.h>

namespace glim::probe_infinities_test {

constexpr std::uint32_t kAnswers = 7, kAll = (1U << kAnswers) - 1;

TEST(ProbeInfinitiesTest, ThisDeviceKeepsThem)
{
    EXPECT_EQ(probeInfinities(testDevice(), makeInfinities()), kAll);
    EXPECT_NO_THROW(refuseLostInfinities(testDevice()));
}

TEST(ProbeInfinitiesTest, LostOnesAreNoticed)
{
    const auto missing = [](auto&& lose) {
        Infinities given = makeInfinities();
        lose(given);
        return kAll & ~probeInfinities(testDevice(), given);
    };
    EXPECT_EQ(missing([](Infinities& i) { i.zero = 1e-30F; }) & 0b1000101U, 0b1000101U);
    EXPECT_EQ(missing([](Infinities& i) { i.largest = 1e10F; }), 0b10U);
    EXPECT_EQ(missing([](Infinities& i) { i.infinity = i.largest; }) & 0b11100U, 0b11100U);
    EXPECT_EQ(missing([](Infinities& i) { i.nan = 0.0F; }), 0b100000U);
}

TEST(ProbeInfinitiesTest, EachMissingAnswerIsRefused)
{
    DeviceDescription device;
    device.name = "toy";
    EXPECT_NO_THROW(refuseLostInfinities(device, kAll));
    for (std::uint32_t i = 0; i < kAnswers; ++i) {
        test::expectRefusal<DeviceError>([&] { refuseLostInfinities(device, kAll & ~(1U << i)); }, MessageId::DeviceLacks,
                                         {.value = "toy"});
    }
}

}  // namespace glim::probe_infinities_test
