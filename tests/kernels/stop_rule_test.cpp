#include "test_kernels.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/luminance_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>

namespace glim::stop_rule_test {

struct Case {
    LuminanceMoments moments;
    float tolerance;
    uint constantSamples;
    uint accurate;
    vec3 color{0.0F};
    float luminance = 0.0F;
};

std::vector<float> judge(const std::vector<Case>& cases)
{
    KernelTest test(test_kernels::stop_rule_test);
    test.cases(cases).resultsOf<float>(cases.size()).run();
    return test.results<float>();
}

TEST(StopRuleTest, LuminanceIsRec709)
{
    Random random(60);
    std::vector<vec3> colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {0, 0, 0}};
    for (int i = 0; i < 100000; ++i) {
        const auto light = static_cast<float>(random.logUniform(1e-6, 1e6));
        colors.push_back(light * vec3(random.unitFloat(), random.unitFloat(), random.unitFloat()));
    }
    std::vector<Case> cases;
    std::vector<double> truth;
    for (const vec3& color : colors) {
        truth.push_back(glm::dot(glm::dvec3(color), glm::dvec3(0.2126, 0.7152, 0.0722)));
        cases.push_back({{}, 0.05F, 0, 0, color, static_cast<float>(truth.back())});
    }
    const std::vector<float> luminances = judge(cases);
    double worst = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        worst = std::max(worst, truth[i] > 0.0 ? std::abs(static_cast<double>(luminances[i]) / truth[i] - 1.0) : 0.0);
    }
    std::cout << "  luminance off by at most " << worst << '\n';
    EXPECT_FLOAT_EQ(luminances[3], 1.0F);
    EXPECT_EQ(luminances[4], 0.0F);
}

TEST(StopRuleTest, AgreesWithTheRuleInDouble)
{
    Random random(61);
    std::vector<Case> cases;
    std::size_t undecided = 0, accurate = 0, near = 0;
    for (int i = 0; i < 300000; ++i) {
        const auto tolerance = static_cast<float>(random.logUniform(1e-3, 0.5));
        const uint constantSamples = random.below(2) == 0 ? 0 : 1024;
        const LuminanceMoments moments = anyLuminance(random, tolerance);
        const std::optional<bool> expected = isAccurateInDouble(moments, tolerance, constantSamples);
        if (!expected) {
            ++undecided;
            continue;
        }
        accurate += *expected ? 1 : 0;
        near += moments.count > 1 && std::abs(shareOfTolerance(moments, tolerance) - 1.0) < 2.0 * kRuleRounding ? 1 : 0;
        cases.push_back({moments, tolerance, constantSamples, *expected ? 1U : 0U});
    }
    std::cout << "  " << accurate << " accurate, " << cases.size() - accurate << " not, " << near
              << " of them within twice what rounding may decide, " << undecided << " left to rounding\n";
    EXPECT_GT(std::min(accurate, cases.size() - accurate), cases.size() / 4);
    EXPECT_LT(undecided, cases.size() / 5);
    EXPECT_GT(near, 1000U);
    judge(cases);
}

// H28: equal samples, black ones too. By the course's literal rule (0) two of them are enough, by ours 1,024.
TEST(StopRuleTest, H28EqualSamples)
{
    std::vector<Case> cases;
    for (const float mean : {0.0F, 0.1F, 3e4F}) {
        for (const uint count : {0U, 1U, 2U, 3U, 32U, 1023U, 1024U, 1025U, 100000U}) {
            cases.push_back({{count, mean, 0.0F}, 0.05F, 0, count >= 2 ? 1U : 0U});
            cases.push_back({{count, mean, 0.0F}, 0.05F, 1024, count >= 1024 ? 1U : 0U});
            cases.push_back({{count, mean, 0.0F}, 0.0F, 1024, count >= 1024 ? 1U : 0U});
        }
        // A single sample says nothing about its error, whatever the sum of squares is.
        cases.push_back({{1, mean, 1e-20F}, 0.05F, 0, 0});
    }
    judge(cases);
}

// Exactly on it: 1.96 * 1 / 2 <= .98 * 1, whose operations are all exact; and one in 1e5 beside it.
TEST(StopRuleTest, TheBoundaryIsAccurate)
{
    const float half = 1.96F / 2.0F;
    judge({{{4, 1.0F, 3.0F}, half, 1024, 1},
           {{4, 1.0F, 3.0F * 1.00002F}, half, 1024, 0},
           {{4, 1.0F, 3.0F}, half * 0.99999F, 1024, 0},
           {{4, 0.99999F, 3.0F}, half, 1024, 0},
           {{4, -1.0F, 3.0F}, half, 1024, 0},
           {{4, 0.0F, 3.0F}, half, 1024, 0}});
}

struct Stream {
    const char* name;
    std::function<float(Random&)> next;
    double mean, deviation;
    float grid;   // of floats about the mean
    double peak;  // density of the samples at their mean, times their deviation
};

const std::vector<Stream>& streams()
{
    static const std::vector<Stream> all = {
        {"constant .1", [](Random&) { return 0.1F; }, 0.1, 0.0, 0x1p-27F, 0.0},
        {"1 + .001 N", [](Random& r) { return static_cast<float>(1.0 + 0.001 * r.normal()); }, 1.0, 0.001, 0x1p-23F, 0.4},
        {"1e4 (1 + .01 N)", [](Random& r) { return static_cast<float>(1e4 + 100.0 * r.normal()); }, 1e4, 100.0, 0x1p-10F, 0.4},
        {"lognormal", [](Random& r) { return static_cast<float>(std::exp(r.normal())); }, std::exp(0.5),
         std::sqrt(std::exp(2.0) - std::exp(1.0)), 0x1p-23F, 0.47}};
    return all;
}

constexpr std::uint32_t kSeeds = 64, kPieces = 4, kPiece = 25000;
constexpr double kSamples = kPieces * kPiece;

struct Sums {
    double mean, squares;
};

Sums inDouble(const std::vector<float>& samples)
{
    double sum = 0.0, squares = 0.0;
    for (const float sample : samples) {
        sum += static_cast<double>(sample);
    }
    const double mean = sum / static_cast<double>(samples.size());
    for (const float sample : samples) {
        squares += std::pow(static_cast<double>(sample) - mean, 2.0);
    }
    return {mean, squares};
}

// kSeeds streams of 1e5 samples: what the device makes of them, and the truth.
std::pair<std::vector<LuminanceMoments>, std::vector<Sums>> addUp(const Stream& stream)
{
    std::vector<std::vector<float>> samples(kSeeds);
    std::vector<Sums> truth;
    for (std::uint32_t s = 0; s < kSeeds; ++s) {
        Random random(62 + s);
        samples[s].resize(kPieces * kPiece);
        std::generate(samples[s].begin(), samples[s].end(), [&] { return stream.next(random); });
        truth.push_back(inDouble(samples[s]));
    }
    KernelTest test(test_kernels::stop_rule_stream_test);
    test.resultsOf<LuminanceMoments>(kSeeds);
    test.pass().sampleCount = kPiece;
    for (std::uint32_t piece = 0; piece < kPieces; ++piece) {
        std::vector<float> part;
        for (const std::vector<float>& all : samples) {
            part.insert(part.end(), all.begin() + piece * kPiece, all.begin() + (piece + 1) * kPiece);
        }
        test.cases(part).threads(kSeeds).run();
    }
    return {test.results<LuminanceMoments>(), truth};
}

// H26. Step k rounds the mean by at most half a grid step, deviation grid / sqrt(12); later samples weigh that down to k / n,
// so that after n of them the mean is off by grid sqrt(n / 36). The sum S of squares is rounded alike, in its own grid of at
// most S 2^-23; takes in the error e of the mean, 2 e deviation sqrt(n) + n e^2; and loses squares below half its grid step,
// which are 2/3 peak (2^-24 k)^1.5 deviation^2 at step k, in the mean over the steps 2/5 of the last one's.
TEST(StopRuleTest, H26LongStreamsAreAccurate)
{
    const double limit = scoreLimit(2 * kSeeds * (streams().size() - 1));
    for (const Stream& stream : streams()) {
        const auto [moments, truth] = addUp(stream);
        const double meanSlack = limit * static_cast<double>(stream.grid) * std::sqrt(kSamples / 36.0);
        const double relative = meanSlack / stream.deviation;
        const double squaresSlack = limit * 0x1p-23 * std::sqrt(kSamples / 36.0) + 2.0 * relative / std::sqrt(kSamples) +
                                    relative * relative + 0.27 * stream.peak * std::pow(kSamples * 0x1p-24, 1.5);
        double worstMean = 0.0, worstSquares = 0.0;
        for (std::uint32_t s = 0; s < kSeeds; ++s) {
            EXPECT_EQ(moments[s].count, kPieces * kPiece);
            if (stream.deviation == 0.0) {
                EXPECT_EQ(moments[s].mean, 0.1F);
                EXPECT_EQ(moments[s].squares, 0.0F);
                continue;
            }
            worstMean = std::max(worstMean, std::abs(static_cast<double>(moments[s].mean) - truth[s].mean) / truth[s].mean);
            worstSquares = std::max(worstSquares, std::abs(static_cast<double>(moments[s].squares) / truth[s].squares - 1.0));
        }
        std::printf("  H26 %s: mean off by at most %.1e (limit %.1e), squares by %.1e (limit %.1e)\n", stream.name, worstMean,
                    meanSlack / stream.mean, worstSquares, stream.deviation > 0.0 ? squaresSlack : 0.0);
        if (stream.deviation > 0.0) {
            EXPECT_LE(worstMean, meanSlack / stream.mean);
            EXPECT_LE(worstSquares, squaresSlack);
        }
    }
}

}  // namespace glim::stop_rule_test
