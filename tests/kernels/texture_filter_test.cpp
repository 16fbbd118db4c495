#include "shaders/shared/scene_types.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/wrapped_texel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glim::texture_filter_test {

struct Case {
    float t;
    std::uint32_t size, wrap;
    float srgb;
};

struct Result {
    std::uint32_t first, second;
    float weight;
    std::uint32_t nearest;
    float linear;
};

std::vector<Result> filtered(const std::vector<Case>& cases)
{
    KernelTest test(test_kernels::texture_filter_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

// A texel's value, any.
double valueOf(std::uint32_t texel) { return std::fmod(texel * 0.618033988749895, 1.0); }

double filteredBy(const Result& r)
{
    const double weight = static_cast<double>(r.weight);
    return valueOf(r.first) * (1.0 - weight) + valueOf(r.second) * weight;
}

double expectedOf(const Case& c)
{
    const double x = static_cast<double>(c.t) * c.size - 0.5, below = std::floor(x);
    return valueOf(test::wrappedTexel(below, c.size, c.wrap)) * (1.0 - (x - below)) +
           valueOf(test::wrappedTexel(below + 1.0, c.size, c.wrap)) * (x - below);
}

// What rounding the wrapped coordinate to float moves a value by, at most; neighbours differ by less than 1.
double tolerance(const Case& c) { return 1e-6 + 0x1p-24 * c.size; }

// Simpler code: texels by the coordinate that is not reduced first.
double naiveOf(const Case& c)
{
    const float x = c.t * static_cast<float>(c.size) - 0.5F, below = std::floor(x);
    const double weight = static_cast<double>(x - below);
    return valueOf(test::wrappedTexel(static_cast<double>(below), c.size, c.wrap)) * (1.0 - weight) +
           valueOf(test::wrappedTexel(static_cast<double>(below) + 1.0, c.size, c.wrap)) * weight;
}

const std::uint32_t kWraps[] = {kRepeat, kMirrored, kClamp};

void expectFiltered(const std::string& name, const std::vector<Case>& cases)
{
    const std::vector<Result> results = filtered(cases);
    double worst = 0.0, naive = 0.0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const double error = std::abs(filteredBy(results[i]) - expectedOf(cases[i]));
        EXPECT_LE(error, tolerance(cases[i])) << cases[i].t << " of " << cases[i].size << ", wrap " << cases[i].wrap;
        worst = std::max(worst, error);
        naive = std::max(naive, std::abs(naiveOf(cases[i]) - expectedOf(cases[i])));
        // Where the coordinate is not next to an edge between texels.
        const double x = static_cast<double>(cases[i].t) * cases[i].size;
        if (std::abs(x - std::round(x)) > tolerance(cases[i])) {
            EXPECT_EQ(results[i].nearest, test::wrappedTexel(std::floor(x), cases[i].size, cases[i].wrap)) << cases[i].t;
        }
    }
    printHardCase("H36", name, static_cast<double>(cases.size()), "within " + figure(worst),
                  "coordinates that are not reduced first: off by up to " + figure(naive));
}

std::vector<Case> randomCases(float most, std::span<const std::uint32_t> sizes)
{
    Random random(5);
    std::vector<Case> cases;
    for (int i = 0; i < 20000; ++i) {
        const std::uint32_t size = sizes[random.below(static_cast<std::uint32_t>(sizes.size()))];
        cases.push_back({static_cast<float>(random.uniform(-1.0, 1.0)) * most, size, kWraps[random.below(3)], 0.0F});
    }
    return cases;
}

TEST(TextureFilterTest, H36BilinearAsInDouble)
{
    const std::uint32_t sizes[] = {1, 2, 3, 7, 16, 100, 128};
    std::vector<Case> cases = randomCases(3.0F, sizes);
    for (const Case& c : cases) {
        ASSERT_LE(tolerance(c), 1e-5);
    }
    expectFiltered("coordinates of -3 to 3, up to 128 texels", cases);
}

TEST(TextureFilterTest, H36LargeCoordinates)
{
    const std::uint32_t sizes[] = {2, 3, 16, 128};
    expectFiltered("coordinates of 1e5", randomCases(1e5F, sizes));
    expectFiltered("coordinates of 1e7, all of them whole or halves", randomCases(1e7F, sizes));
}

TEST(TextureFilterTest, H36WideTextures)
{
    const std::uint32_t sizes[] = {16384, 16383, 1};
    expectFiltered("16,384 texels wide", randomCases(2.0F, sizes));
}

// At the centre of each texel the value is the texel's own, in every repetition.
TEST(TextureFilterTest, CentresAreExact)
{
    std::vector<Case> cases;
    std::vector<double> expected;
    for (const std::uint32_t size : {1U, 2U, 64U, 16384U}) {
        for (const std::uint32_t wrap : kWraps) {
            for (std::uint32_t i = 0; i < size; i += std::max(1U, size / 64)) {
                for (const int tile : {0, 1, -2}) {
                    if (wrap == kClamp && tile != 0) {
                        continue;
                    }
                    const std::uint32_t place = wrap == kMirrored && tile == 1 ? size - 1 - i : i;
                    cases.push_back({static_cast<float>((place + 0.5) / size + tile), size, wrap, 0.0F});
                    expected.push_back(valueOf(i));
                }
            }
        }
    }
    const std::vector<Result> results = filtered(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        EXPECT_EQ(filteredBy(results[i]), expected[i]) << cases[i].t << " of " << cases[i].size;
    }
}

TEST(TextureFilterTest, EdgesOfTheImageAndNumbersThatAreNotFinite)
{
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    std::vector<Case> cases;
    for (const std::uint32_t size : {1U, 2U, 5U, 16384U}) {
        for (const std::uint32_t wrap : kWraps) {
            for (const float t : {0.0F, -0.0F, 1.0F, -1.0F, 2.0F, -0x1p-24F, -1e-38F, 1.0F - 0x1p-24F, 1.0F + 0x1p-23F, -1.0F - 0x1p-23F}) {
                cases.push_back({t, size, wrap, 0.0F});
            }
        }
    }
    expectFiltered("edges of the image", cases);
    std::vector<Case> broken;
    for (const float t : {kInfinite, -kInfinite, std::numeric_limits<float>::quiet_NaN(), 1e38F, -1e38F, 0x1p24F + 2.0F}) {
        for (const std::uint32_t wrap : kWraps) {
            broken.push_back({t, 5, wrap, 0.0F});
        }
    }
    filtered(broken);  // the kernel checks that all texels are in the image
}

// Every code of 8 and of 16 bits.
TEST(TextureFilterTest, H36SrgbAsItsFormula)
{
    for (const std::uint32_t most : {255U, 65535U}) {
        std::vector<Case> cases;
        for (std::uint32_t code = 0; code <= most; ++code) {
            cases.push_back({0.0F, 1, kRepeat, static_cast<float>(code) / static_cast<float>(most)});
        }
        const std::vector<Result> results = filtered(cases);
        double worst = 0.0, before = -1.0;
        for (std::size_t code = 0; code < cases.size(); ++code) {
            const double linear = static_cast<double>(results[code].linear);
            worst = std::max(worst, std::abs(linear - test::linearFromSrgb(static_cast<double>(code) / most)));
            EXPECT_GT(linear, before) << code;
            before = linear;
        }
        EXPECT_LE(worst, 1e-6);
        printHardCase("H36", "sRGB, " + std::to_string(most + 1) + " codes", static_cast<double>(cases.size()), "within " + figure(worst));
    }
}

}  // namespace glim::texture_filter_test
