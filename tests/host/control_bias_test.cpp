// The interval that control pixels give: simulated renders whose bias is known.
#include "host/measure/control_bias.hpp"
#include "tests/harness/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace glim {
namespace {

constexpr std::size_t kPixels = 192;

struct Simulated {
    Film film, control;
};

// Pixels of different radiance, most of them dark; noise in proportion. One in three is a control pixel.
Simulated simulate(Random& random, double bias)
{
    Simulated simulated;
    for (Film* film : {&simulated.film, &simulated.control}) {
        film->pixels.resize(kPixels);
    }
    for (std::size_t i = 0; i < kPixels; ++i) {
        const double truth = std::pow(random.uniform(), 4.0);
        const auto noisy = [&] {
            const double noise = random.uniform() + random.uniform() + random.uniform() - 1.5;
            return glm::vec3(static_cast<float>(truth * (1.0 + 0.3 * noise)));
        };
        simulated.film.pixels[i].count = 64;
        simulated.film.pixels[i].mean = noisy() * static_cast<float>(1.0 + bias);
        if (i % 3 == 0) {
            simulated.control.pixels[i].count = 64;
            simulated.control.pixels[i].mean = noisy();
        }
    }
    return simulated;
}

TEST(ControlBiasTest, IntervalsHoldTheBias)
{
    constexpr int kRuns = 2000;
    for (const double bias : {0.0, -0.05}) {
        Random random(7);
        int held = 0;
        double sum = 0.0;
        for (int run = 0; run < kRuns; ++run) {
            const Simulated simulated = simulate(random, bias);
            const auto estimate = estimateControlBias(simulated.film, simulated.control);
            ASSERT_TRUE(estimate);
            EXPECT_EQ(estimate->pixels, kPixels / 3);
            held += estimate->bias.low <= bias && bias <= estimate->bias.high ? 1 : 0;
            sum += estimate->bias.value / kRuns;
        }
        std::printf("bias %g: mean of %d estimates %.5f, %d intervals hold it\n", bias, kRuns, sum, held);
        // Five standard deviations of a count of probability .95; the ratio's own bias is of the order of 1 / pixels.
        EXPECT_NEAR(held, 0.95 * kRuns, 5.0 * std::sqrt(0.95 * 0.05 * kRuns));
        EXPECT_NEAR(sum, bias, 1e-3);
    }
}

TEST(ControlBiasTest, FewPixelsOrNoLightTellNothing)
{
    Random random(8);
    Simulated simulated = simulate(random, 0.0);
    for (std::size_t i = 93; i < kPixels; ++i) {
        simulated.control.pixels[i] = {};
    }
    EXPECT_FALSE(estimateControlBias(simulated.film, simulated.control));  // 31 pixels
    simulated = simulate(random, 0.0);
    for (PixelMoments& pixel : simulated.control.pixels) {
        pixel.mean = glm::vec3(0.0F);
    }
    EXPECT_FALSE(estimateControlBias(simulated.film, simulated.control));
}

}  // namespace
}  // namespace glim
