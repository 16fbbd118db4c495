// --paths and --bounces: light by the surfaces it has met.
#include "tests/support/build_scene.hpp"
#include "tests/support/named.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

namespace glim {
namespace {

constexpr std::uint32_t kPartBounces = 6, kPartSamples = 64;

Film render(PathParts paths, std::uint32_t bounces, DirectLight direct, Schedule schedule = Schedule::Auto)
{
    RenderSettings settings = squareSettings(40, kPartSamples);
    settings.bounces = bounces;
    settings.paths = paths;
    settings.course.direct = direct;
    settings.schedule = schedule;
    return renderScene(mixedScene(), settings);
}

class PathPartsTest : public testing::TestWithParam<test::Named<DirectLight>> {};

// Bit for bit where one part alone shines; elsewhere each of at most 2 kPartBounces + 1 additions of a sample, 32 of a block and 3 of
// the fold rounds by 2^-24.
TEST_P(PathPartsTest, AddUpToAll)
{
    const Film all = render(PathParts::All, kPartBounces, GetParam().value);
    const Film parts[] = {render(PathParts::Emission, kPartBounces, GetParam().value),
                          render(PathParts::Direct, kPartBounces, GetParam().value),
                          render(PathParts::Indirect, kPartBounces, GetParam().value)};
    const double reach = 2.0 * (2 * kPartBounces + 1 + 32 + 3) * 0x1p-24;
    int alone = 0;
    double worst = 0.0;
    for (std::size_t i = 0; i < all.pixels.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const float whole = all.pixels[i].mean[k];
            const float part[] = {parts[0].pixels[i].mean[k], parts[1].pixels[i].mean[k], parts[2].pixels[i].mean[k]};
            const double sum = static_cast<double>(part[0]) + static_cast<double>(part[1]) + static_cast<double>(part[2]);
            if (std::count(part, part + 3, 0.0F) == 2) {
                ++alone;
                EXPECT_EQ(sum, static_cast<double>(whole));
            }
            worst = std::max(worst, std::abs(sum - static_cast<double>(whole)) / static_cast<double>(whole));
        }
    }
    EXPECT_LE(worst, reach);
    EXPECT_GT(alone, 100) << "channels of pixels with one part alone";
    std::printf("largest relative difference %.1e, one part alone in %d\n", worst, alone);
}

INSTANTIATE_TEST_SUITE_P(Ways, PathPartsTest,
                         testing::Values(test::Named{"mis", DirectLight::Mis}, test::Named{"lights", DirectLight::Lights},
                                         test::Named{"hemisphere", DirectLight::Hemisphere}, test::Named{"bsdf", DirectLight::Bsdf}),
                         test::nameOfParameter);

TEST(PathPartsTest, AreWhatFewerBouncesGive)
{
    // AddUpToAll and ScheduleTest compare the schedules.
    const auto by = [](PathParts paths, std::uint32_t bounces) { return render(paths, bounces, DirectLight::Mis, Schedule::Persistent); };
    const auto sameMeans = [](const Film& a, const Film& b) {
        return std::equal(a.pixels.begin(), a.pixels.end(), b.pixels.begin(),
                          [](const PixelMoments& x, const PixelMoments& y) { return x.mean == y.mean; });
    };
    const Film none = by(PathParts::All, 0), one = by(PathParts::All, 1);
    EXPECT_TRUE(sameMeans(by(PathParts::Emission, 100), none));
    EXPECT_FALSE(sameMeans(none, one));
    EXPECT_TRUE(sameMeans(by(PathParts::Direct, 1), by(PathParts::Direct, 100)));
    EXPECT_EQ(meanOf(by(PathParts::Indirect, 1)).mean, glm::dvec3(0.0));
    double last = meanOf(one).mean.g;
    for (const std::uint32_t bounces : {2U, 3U, 100U}) {
        const double mean = meanOf(by(PathParts::All, bounces)).mean.g;
        EXPECT_GT(mean, last) << bounces;
        last = mean;
    }
}

}  // namespace
}  // namespace glim
