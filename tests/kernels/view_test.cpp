// The viewer shows the colours that files and `glim compare` have.
#include "host/render/aov.hpp"
#include "host/view/layers.hpp"
#include "shaders/shared/display_colors.h"
#include "shaders/shared/display_types.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace glim::view_test {

struct Case {
    vec3 value, reference;
    ViewPass view;
    uvec2 at;
    vec3 expected;
};

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

vec3 bytesOf(const Rgb8& color) { return {color[0], color[1], color[2]}; }

bool isFinite(const vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// The colour that the host gives to a pixel of a film which has this value in the layer.
vec3 colorOfFilm(const Case& c)
{
    PixelMoments pixel{};
    pixel.count = 1;
    const DisplayRange range{c.view.low, c.view.high};
    const Look look{std::log2(static_cast<double>(c.view.scale)), static_cast<Tone>(c.view.tone)};
    if (c.view.shownAs == kShownAsError) {
        return bytesOf(roundToBytes(errorColor(static_cast<double>(c.value.x), static_cast<double>(range.high))));
    }
    if (c.view.shownAs == kShownAsSurfaces) {
        pixel.mean = c.value;
        pixel.alpha = c.reference.x;
        const Rgba8 color = displaySurfaces(pixel, Aov::Radiance, range, look);
        return bytesOf(roundToBytes(overCheckers({color[0], color[1], color[2]}, c.reference.x, c.at.x, c.at.y)));
    }
    switch (static_cast<ShownAs>(c.view.shownAs)) {
    case ShownAs::Vector:
        pixel.normal = c.value;
        pixel.alpha = c.value == vec3(0.0F) ? 0.0F : 1.0F;
        return bytesOf(displayColor(pixel, Aov::Normal, range, look));
    case ShownAs::Depth:
        pixel.depth = c.value.x;
        pixel.alpha = c.value.x == 0.0F ? 0.0F : 1.0F;
        return bytesOf(displayColor(pixel, Aov::Depth, range, look));
    case ShownAs::Heat: {
        const glm::dvec3 v(c.value);
        const double low = static_cast<double>(range.low), high = static_cast<double>(range.high);
        return bytesOf(roundToBytes(heatColor(((v.x + v.y + v.z) / 3.0 - low) / (high - low))));
    }
    default: pixel.mean = c.value; return bytesOf(displayColor(pixel, Aov::Radiance, range, look));
    }
}

// As host/measure/error_picture.hpp defines it.
vec3 colorOfDifference(const Case& c)
{
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double x = static_cast<double>(c.value[k]), r = static_cast<double>(c.reference[k]);
        const double divisor = std::sqrt(static_cast<double>(c.view.relative) * r * r + static_cast<double>(c.view.epsilon));
        sum += x == r ? 0.0 : (x - r) / divisor;
    }
    return bytesOf(roundToBytes(differenceColor(static_cast<double>(c.view.scale) * sum / 3.0)));
}

TEST(ViewColorTest, ColoursAreThoseOfFilesAndOfCompare)
{
    std::mt19937 random(11);
    std::lognormal_distribution<float> light(-1.0F, 2.0F);
    std::uniform_real_distribution<float> unit;
    std::vector<Case> cases(60000);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        Case& c = cases[i];
        c.view.shownAs = static_cast<std::uint32_t>(i % 7);
        c.at = {i % 101, i / 101};
        const bool isVector = c.view.shownAs == kShownAsVector, differs = c.view.shownAs == kShownAsDifference;
        c.value = isVector ? glm::normalize(vec3(unit(random) - 0.5F, unit(random) - 0.5F, unit(random) - 0.5F))
                           : vec3(light(random), light(random), light(random));
        c.reference = random() % 2 == 0 ? c.value * (0.5F + unit(random)) : vec3(light(random), light(random), light(random));
        c.view.scale = std::exp2(static_cast<float>(i % 7) - 3.0F);
        c.view.tone = static_cast<std::uint32_t>(i / 7 % 3);
        c.view.low = light(random);
        c.view.high = c.view.low + 0.1F + light(random);
        c.view.relative = i / 7 % 2 == 0 ? 1.0F : 0.0F;
        c.view.epsilon = c.view.relative == 1.0F ? 0.01F : 1.0F;
        if (c.view.shownAs == kShownAsSurfaces) {
            c.reference = vec3(random() % 4 == 0 ? std::round(unit(random)) : unit(random));
        }
        if (i % 31 == 0) {
            (random() % 2 == 0 ? c.value : c.reference) = vec3(0.0F);
        }
        if (i % 89 == 0 && c.view.shownAs != kShownAsSurfaces) {
            (random() % 2 == 0 ? c.value : c.reference)[static_cast<int>(i % 3)] = i % 2 == 0 ? kNan : kInfinity;
        }
        const bool finite = isFinite(c.value) && (!differs || isFinite(c.reference));
        c.expected = !finite ? bytesOf(kMagenta) : differs ? colorOfDifference(c) : colorOfFilm(c);
    }
    KernelTest test(test_kernels::view_test);
    test.cases(cases).resultsOf<vec3>(cases.size()).run();
}

// Where the reference is black and nothing is added to it, any light is infinitely wrong, and none is right.
TEST(ViewColorTest, ABlackReferenceLeavesOnlyRightAndWrong)
{
    ViewPass view{};
    view.shownAs = kShownAsDifference;
    view.scale = 0.01F;
    view.relative = 1.0F;
    const std::vector<Case> cases{{vec3(0.0F), vec3(0.0F), view, {}, vec3(255.0F)},
                                  {vec3(1e-9F), vec3(0.0F), view, {}, bytesOf(roundToBytes(differenceColor(1.0)))},
                                  {vec3(-1e-9F), vec3(0.0F), view, {}, bytesOf(roundToBytes(differenceColor(-1.0)))}};
    KernelTest test(test_kernels::view_test);
    test.cases(cases).resultsOf<vec3>(cases.size()).run();
}

// The colour changes at the target, and nowhere else so much.
TEST(ViewColorTest, ErrorsAreBlueUpToTheTargetAndRedBeyondIt)
{
    ViewPass view{};
    view.shownAs = kShownAsError;
    view.high = 0.003F;
    const float next = std::nextafter(view.high, 1.0F);
    const std::vector<Case> cases{{vec3(0.0F), {}, view, {}, {0, 0, 255}},          {vec3(1e-2F * view.high), {}, view, {}, {0, 0, 255}},
                                  {vec3(view.high), {}, view, {}, {0, 255, 255}},   {vec3(next), {}, view, {}, {255, 255, 0}},
                                  {vec3(100.0F * next), {}, view, {}, {255, 0, 0}}, {vec3(1e30F), {}, view, {}, {255, 0, 0}},
                                  {vec3(-1.0F), {}, view, {}, vec3(128.0F)},        {vec3(kNan), {}, view, {}, bytesOf(kMagenta)}};
    KernelTest test(test_kernels::view_test);
    test.cases(cases).resultsOf<vec3>(cases.size()).run();
}

}  // namespace glim::view_test
