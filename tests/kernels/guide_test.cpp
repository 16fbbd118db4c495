// The guide's samples have the density that it states, which integrates to 1 over all directions.
// Once they had not: values after a loop were wrong on one driver (shaders/driver_bugs.md), and pictures a percent too bright.
#include "host/render/build_guide.hpp"
#include "host/render/guide_buffers.hpp"
#include "host/render/guide_map.hpp"
#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/guide_records.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace glim::guide_test {

struct Case {
    vec3 p, n;
    vec2 u;
    vec3 w;
};

struct Result {
    vec3 sampled;
    float pdf, evaluated, pdfOfW, share;
};

int binOf(const vec3& w)
{
    return (w.x > 0.0F ? 1 : 0) + (w.y > 0.0F ? 2 : 0) + (w.z > 0.0F ? 4 : 0) + (std::abs(w.x) > std::abs(w.y) ? 8 : 0) +
           (std::abs(w.y) > std::abs(w.z) ? 16 : 0);
}

constexpr int kSide = 700;

// Each of kSide^2 parts of the sphere has one: leaves may be as small, and of random directions two of three parts would have none or too
// many.
vec3 directionIn(int part, Random& random)
{
    const double z = 2.0 * (part % kSide + random.uniform()) / kSide - 1.0;
    const double angle = 2.0 * 3.141592653589793 * (part / kSide + random.uniform()) / kSide, radius = std::sqrt(1.0 - z * z);
    return vec3(glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), z));
}

void expectStatedDensity(const Buffer& texels, const vec3& p, const vec3& n, float share, Random& random)
{
    std::vector<Case> cases;
    for (int i = 0; i < kSide * kSide; ++i) {
        cases.push_back({p, n, vec2(random.uniform(), random.uniform()), directionIn(i, random)});
        cases.back().u = glm::min(cases.back().u, vec2(0x1.fffffep-1F));
    }
    KernelTest test(test_kernels::guide_test);
    test.buffers({{kBindGuide, &texels}}).cases(cases).resultsOf<Result>(cases.size()).run();
    const std::vector<Result> results = test.results<Result>();
    std::array<double, 32> counts{}, sums{}, squares{};
    double differs = 0.0;
    for (std::size_t i = 0; i < results.size(); ++i) {
        EXPECT_EQ(results[i].share, share);
        EXPECT_GT(results[i].pdfOfW, 0.0F) << "no direction is left out";
        counts[binOf(results[i].sampled)] += 1.0;
        const double weight = 4.0 * 3.141592653589793 * static_cast<double>(results[i].pdfOfW);
        sums[binOf(cases[i].w)] += weight;
        squares[binOf(cases[i].w)] += weight * weight;
        differs += std::abs(results[i].pdf - results[i].evaluated) > 1e-3F * results[i].pdf ? 1.0 : 0.0;
    }
    EXPECT_LT(differs, 1e-3 * static_cast<double>(results.size())) << "only at the edges of leaves";
    for (int bin = 0; bin < 32; ++bin) {
        const double error = std::sqrt(counts[bin] + squares[bin] + 1.0);
        EXPECT_NEAR(counts[bin], sums[bin], 5.0 * error) << "bin " << bin;
    }
}

Buffer upload(const Guide& guide)
{
    Buffer texels(testDevice(), "guide", BufferKind::Texel, guide.texels.size() * sizeof(uvec4));
    glim::upload(texels, std::span<const uvec4>(guide.texels));
    return texels;
}

TEST(GuideTest, SamplesHaveTheStatedDensity)
{
    Random random(3);
    const Guide guide = guideOf(recordsOfBall(200000, random));
    ASSERT_GT(guide.cells, 6U);
    const Buffer texels = upload(guide);
    for (const vec3 p : {vec3(0.1F, 0.2F, -0.3F), vec3(0.9F, 0.2F, -0.3F), vec3(-3.0F, 5.0F, 0.0F)}) {
        for (const vec3 n : {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1)}) {
            expectStatedDensity(texels, p, n, 0.7F, random);
        }
    }
}

// All records are of one normal, and too few for a quadtree.
TEST(GuideTest, WithoutAQuadtreeDirectionsAreUniformOverTheSquare)
{
    Random random(4);
    std::vector<GuideRecord> records = recordsOfBall(60, random);
    for (GuideRecord& record : records) {
        record.normal = encodeDirection({0, 1, 0});
    }
    const Buffer texels = upload(guideOf(records));
    for (const vec3 n : {vec3(1, 0, 0), vec3(0, 1, 0)}) {
        expectStatedDensity(texels, vec3(0.1F), n, 0.0F, random);
    }
}

// What the window shows of a guide.
struct Shown {
    Shown()
        : guide(guideOf(recordsOfBall(200000, random))),
          texels(testDevice(), "guide", BufferKind::Texel, guide.texels.size() * sizeof(uvec4)),
          probe(testDevice())
    {
        glim::upload(texels, std::span<const uvec4>(guide.texels));
    }

    Random random{5};
    Guide guide;
    Buffer texels;
    GuideProbe probe;
};

TEST(GuideProbeTest, HasTheDensitiesOfPaths)
{
    Shown shown;
    const vec3 p(0.1F, 0.2F, -0.3F), n(0, 1, 0);
    std::vector<Case> cases;
    std::vector<vec3> directions;
    for (int i = 0; i < 1000; ++i) {
        directions.emplace_back(shown.random.direction());
        cases.push_back({p, n, vec2(0.5F), directions.back()});
    }
    KernelTest test(test_kernels::guide_test);
    test.buffers({{kBindGuide, &shown.texels}}).cases(cases).resultsOf<Result>(cases.size()).run();
    const std::vector<Result> results = test.results<Result>();
    const std::vector<ProbedDirection> probed = shown.probe.ask(shown.texels, p, n, directions);
    ASSERT_EQ(probed.size(), results.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
        EXPECT_EQ(probed[i].pdf, results[i].pdfOfW) << i;
        EXPECT_EQ(probed[i].share, results[i].share) << i;
    }
}

TEST(GuideMapTest, TheCamerasAxisIsInTheMiddle)
{
    Shown shown;
    const vec3 p(0.1F, 0.2F, -0.3F);
    const glm::dvec3 ball = glm::normalize(glm::dvec3(1.6, 0.3, -0.4) - glm::dvec3(p));
    FlatCamera camera{};
    camera.right = vec3(-0.5F, 0.0F, 0.0F);  // as long as half the film
    camera.up = vec3(0.0F, 0.25F, 0.0F);
    camera.forward = vec3(0, 0, 1);
    const GuideMap map = shown.probe.map(shown.texels, p, vec3(0, 1, 0), camera);
    EXPECT_EQ(map.share, 0.7F);
    // The ball is seen at an angle of 4 degrees, and a cell has 5.6.
    const double column = (0.5 + std::atan2(-ball.x, ball.z) / (2.0 * std::numbers::pi)) * GuideMap::kColumns;
    const double row = (0.5 - std::asin(ball.y) / std::numbers::pi) * GuideMap::kRows;
    double sum = 0.0;
    for (int y = 0; y < GuideMap::kRows; ++y) {
        for (int x = 0; x < GuideMap::kColumns; ++x) {
            const GuideMap::Cell& cell = map.cells[static_cast<std::size_t>(y * GuideMap::kColumns + x)];
            EXPECT_EQ(cell.isBelow, y >= GuideMap::kRows / 2);
            const double sine = std::sin(std::numbers::pi * (y + 0.5) / GuideMap::kRows);
            sum += static_cast<double>(cell.density) * 0.5 * std::numbers::pi * sine / (GuideMap::kColumns * GuideMap::kRows);
            if (cell.density == map.highestDensity()) {
                EXPECT_LT(std::abs(x + 0.5 - column), 1.5);
                EXPECT_LT(std::abs(y + 0.5 - row), 1.5);
            }
        }
    }
    EXPECT_NEAR(sum, 1.0, 0.02);
    EXPECT_GT(map.highestDensity(), 50.0F);
    EXPECT_EQ(shown.probe.map(GuideBuffers(testDevice(), emptyGuide(), 0).texels(), p, vec3(0, 1, 0), camera).share, 0.0F);
}

}  // namespace glim::guide_test
