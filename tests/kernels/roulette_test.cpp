#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/random.hpp"
#include "tests/support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <numeric>

namespace glim {
namespace {

constexpr std::uint32_t kFreeBounces = 3;  // H24: roulette after bounce 3

struct Case {
    vec3 throughput;
    float etaScale;
    std::uint32_t bounce;
    float survival;
};

struct Result {
    float light;
    std::uint32_t events;
};

Case caseOf(Random& random)
{
    Case c{{random.uniform(), random.uniform(), random.uniform()}, 1.0F, random.below(8), 1.0F};
    c.throughput *= static_cast<float>(random.logUniform(1e-4, 4.0));
    c.etaScale = static_cast<float>(random.logUniform(0.3, 3.0));
    const double largest = static_cast<double>(std::max({c.throughput.r, c.throughput.g, c.throughput.b}));
    c.survival = c.bounce < kFreeBounces
                     ? 1.0F
                     : static_cast<float>(std::min(1.0, largest * static_cast<double>(c.etaScale)));
    return c;
}

// H24, T17: the mean of a furnace is kept, its standard deviation is that of a path that ends with probability 1 - a, and a
// path has a / (1 - a) events after the first, up to those that the free bounces add.
void expectFurnace(float albedo)
{
    const double a = static_cast<double>(albedo);
    std::vector<double> light, events;
    for (int round = 0; round < testRounds(); ++round) {
        Random random(static_cast<std::uint64_t>(round) + 70);
        std::vector<Case> cases(200000);
        std::generate(cases.begin(), cases.end(), [&random] { return caseOf(random); });
        KernelTest test(test_kernels::roulette_test);
        test.pass().seed = static_cast<std::uint32_t>(round) + 1;
        test.pass().environment.x = albedo;
        test.cases(cases).resultsOf<Result>(cases.size()).run();
        for (const Result& result : test.results<Result>()) {
            light.push_back(static_cast<double>(result.light));
            events.push_back(result.events);
        }
    }
    const std::string what = "albedo " + std::to_string(albedo);
    expectSampleMean(what + ", light", light, 1.0 / (1.0 - a), 4);
    // Three free events, the first roulette with a^4, later ones with a.
    const double length = 4.0 + std::pow(a, 4.0) / (1.0 - a);
    expectSampleMean(what + ", events", events, length, 4);
    const double mean = 1.0 / (1.0 - a), n = static_cast<double>(light.size());
    const double squares = std::accumulate(light.begin(), light.end(), 0.0, [mean](double sum, double x) {
        return sum + (x - mean) * (x - mean);
    });
    // After the free part, of certain light, what remains is geometric with throughput 1: mean 1 / (1 - a), entered with
    // probability a^4. Its second moment is (1 + a) / (1 - a)^2.
    const double p = std::pow(a, 4.0), rest = 1.0 / (1.0 - a);
    const double deviation = std::sqrt(p * (1.0 + a) * rest * rest - p * p * rest * rest);
    std::cout << "  " << what << ": standard deviation " << std::sqrt(squares / n) << ", expected " << deviation << '\n';
    EXPECT_NEAR(std::sqrt(squares / n) / deviation, 1.0, 0.05);
}

TEST(RouletteTest, KeepsTheMeanOfABrightFurnace)
{
    expectFurnace(0.99F);
}

TEST(RouletteTest, KeepsTheMeanOfADimFurnace)
{
    expectFurnace(0.5F);
}

}  // namespace
}  // namespace glim
