// The window shows the colours that files have.
#include "host/render/aov.hpp"
#include "shaders/shared/display_colors.h"
#include "shaders/shared/display_types.h"
#include "shaders/shared/luminance.h"
#include "test_kernels.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace glim::display_test {

struct Case {
    PixelMoments pixel;
    uint aov;
    DisplayPass display;
    uvec2 at;
    vec3 expected;
};

vec3 bytesOf(const RealVec3& color)
{
    const Rgb8 bytes = roundToBytes(color);
    return {bytes[0], bytes[1], bytes[2]};
}

// By the functions that files are written with.
vec3 colorOf(const Case& c, const DisplayRange& range, const Look& look)
{
    const Aov aov = static_cast<Aov>(c.aov);
    if (c.display.drawn == kDrawnOverCheckers) {
        const Rgba8 color = displaySurfaces(c.pixel, aov, range, look);
        const float alpha = color == Rgba8{kMagenta[0], kMagenta[1], kMagenta[2], 255} ? 1.0F : c.pixel.alpha;  // 8 bits are too few
        return bytesOf(overCheckers({color[0], color[1], color[2]}, alpha, c.at.x, c.at.y));
    }
    const Rgb8 color = displayColor(c.pixel, aov, range, look);
    const vec3 shown(color[0], color[1], color[2]);
    return c.display.drawn == kDrawnInGrey ? bytesOf(RealVec3(computeLuminance(shown))) : shown;
}

// Radiance as bytes by conversion alone, as the kernel has it; cases 0 and 97 have NaN in red and infinity in green.
void expectIndicesOutside(const std::vector<uvec3>& naive)
{
    const auto outside = std::count_if(naive.begin(), naive.end(), [](uvec3 i) { return std::max({i.x, i.y, i.z}) > 255; });
    printHardCase("H40", "radiance, NaN and infinity as bytes", static_cast<double>(naive.size()), "as on the host",
                  "uint(255 x): " + std::to_string(outside) + " beyond 255; NaN is " + std::to_string(naive[0].x) + ", infinity " +
                      std::to_string(naive[97].y));
    EXPECT_GT(outside, 0);
}

TEST(DisplayTest, H40ColoursAreThoseOfTheHost)
{
    std::mt19937 random(3);
    std::lognormal_distribution<float> value(-1.0F, 2.0F);
    std::uniform_real_distribution<float> unit;
    std::vector<Case> cases(60000);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        Case& c = cases[i];
        constexpr std::array kShown{Aov::Radiance, Aov::Normal, Aov::Depth, Aov::Albedo, Aov::BvhSteps, Aov::SampleCount};
        const Aov aov = kShown[i % kShown.size()];
        c.pixel.count = static_cast<std::uint32_t>(1 + random() % 5000);
        c.pixel.mean = {value(random), value(random), value(random)};
        c.pixel.alpha = random() % 4 == 0 ? 0.0F : unit(random);
        c.pixel.albedo = i % 11 == 0 ? c.pixel.mean : vec3(unit(random), unit(random), unit(random));  // as of unlit surfaces
        c.pixel.normal = c.pixel.alpha * glm::normalize(vec3(unit(random) - 0.5F, unit(random) - 0.5F, 0.2F));
        c.pixel.depth = c.pixel.alpha > 0.0F ? value(random) : std::numeric_limits<float>::infinity();
        if (i % 97 == 0) {
            c.pixel.mean[static_cast<int>(i % 3)] =
                i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
        }
        const float low = i % 5 == 0 ? 7.0F : value(random);
        const DisplayRange range{low, i % 5 == 0 ? low : low + value(random)};
        const Look look{static_cast<double>(i % 7) - 3.0, static_cast<Tone>(i / 6 % 3)};
        c.aov = static_cast<std::uint32_t>(aov);
        c.display.scale = static_cast<float>(std::exp2(look.exposure));
        c.display.tone = static_cast<std::uint32_t>(look.tone);
        c.display.low = range.low;
        c.display.high = range.high;
        c.display.drawn = static_cast<std::uint32_t>(i / 18 % 3);
        c.at = {i % 100, i / 100};
        c.expected = colorOf(c, range, look);
    }
    KernelTest test(test_kernels::display_test);
    test.cases(cases).resultsOf<uvec3>(cases.size()).run();
    expectIndicesOutside(test.results<uvec3>());
}

}  // namespace glim::display_test
