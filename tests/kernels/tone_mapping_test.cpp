// Tone mapping on the device and on the host, which share its text, against the reference in double (tests/oracle/tone.py).
#include "shaders/shared/tone_mapping.h"
#include "host/render/aov.hpp"
#include "test_kernels.hpp"
#include "tests/support/oracle_cases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glim::tone_mapping_test {

struct Case {
    vec3 color;
    float tone;
    vec3 expected;
};

const std::vector<Case>& cases()
{
    static const std::vector<Case> kCases = oracleCases<Case>("tone_cases");
    return kCases;
}

// As a byte of a picture.
Rgb8 shownAs(const vec3& color, Tone tone)
{
    PixelMoments pixel{};
    pixel.count = 1;
    pixel.mean = color;
    return displayColor(pixel, Aov::Radiance, {}, {0.0, tone});
}

TEST(ToneMappingTest, DeviceIsTheReferences)
{
    // An exposure may make infinity of what is finite.
    std::vector<Case> all = cases();
    for (const Case& c : cases()) {
        if (c.color == vec3(1e30F)) {
            all.push_back({vec3(std::numeric_limits<float>::infinity()), c.tone, c.expected});
        }
    }
    EXPECT_EQ(all.size(), cases().size() + 2);
    compareWithOracle("tone mapping on the device", test_kernels::tone_mapping_test, all);
}

TEST(ToneMappingTest, HostIsTheReferences)
{
    double largest = 0.0;
    for (const Case& c : cases()) {
        const vec3 shown = mapTone(c.color, static_cast<uint>(c.tone));
        for (int k = 0; k < 3; ++k) {
            largest = std::max(largest, std::abs(static_cast<double>(shown[k]) - static_cast<double>(c.expected[k])));
            ASSERT_TRUE(shown[k] >= 0.0F && shown[k] <= 1.0F) << shown[k];
        }
    }
    std::cout << "  tone mapping on the host: " << cases().size() << " cases, errors up to " << largest << '\n';
    EXPECT_LT(largest, 1e-5);
}

TEST(ToneMappingTest, NoneChangesNothing)
{
    for (const vec3 color : {vec3(-1.0F, 0.5F, 7.0F), vec3(1e30F, 0.0F, std::numeric_limits<float>::infinity())}) {
        EXPECT_EQ(mapTone(color, kToneNone), color);
    }
}

// Khronos' promise: below the compression a colour loses the same in all channels, at most .04, so base colours keep their hue.
TEST(ToneMappingTest, NeutralShiftsColoursThatAreNotBright)
{
    for (const Case& c : cases()) {
        if (std::max({c.color.r, c.color.g, c.color.b}) > 0.75F) {
            continue;
        }
        const vec3 lost = c.color - mapTone(c.color, kToneNeutral);
        const float least = std::min({c.color.r, c.color.g, c.color.b});
        const float expected = least < 0.08F ? least - 6.25F * least * least : 0.04F;
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(lost[k], expected, 1e-6F);
        }
    }
}

TEST(ToneMappingTest, LightStaysInOrder)
{
    for (const Tone tone : {Tone::Neutral, Tone::Agx}) {
        Rgb8 before{};
        for (float light = 1e-6F; light < 1e6F; light *= 1.01F) {
            const Rgb8 shown = shownAs(vec3(light), tone);
            for (std::size_t k = 0; k < 3; ++k) {
                ASSERT_GE(shown[k], before[k]) << getName(tone) << " at " << light;
            }
            before = shown;
        }
        EXPECT_EQ(before, (Rgb8{255, 255, 255})) << getName(tone);
        EXPECT_EQ(shownAs(vec3(0.0F), tone), (Rgb8{0, 0, 0})) << getName(tone);
    }
}

TEST(ToneMappingTest, TheBrightestLightIsWhite)
{
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const Tone tone : {Tone::Neutral, Tone::Agx}) {
        for (const vec3 color : {vec3(1e30F), vec3(1e30F, 0.0F, 0.0F), vec3(0.0F, 1.0F, 3e38F)}) {
            EXPECT_EQ(shownAs(color, tone), (Rgb8{255, 255, 255})) << getName(tone);
        }
        for (const vec3 color : {vec3(kInfinity), vec3(0.0F, kInfinity, 0.0F)}) {
            const vec3 shown = mapTone(color, static_cast<uint>(tone));
            EXPECT_TRUE(glm::all(glm::greaterThan(shown, vec3(0.99F)))) << getName(tone);
        }
    }
}

}  // namespace glim::tone_mapping_test
