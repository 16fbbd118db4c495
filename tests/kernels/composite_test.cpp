// The window composites pixels with shadow catchers as files do.
#include "shaders/shared/composite.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <random>

namespace glim::composite_test {

struct Case {
    PixelMoments shown;
    CatcherMoments catcher;
    vec3 mean;
    float alpha;
};

// A share of the pixel's samples met the catcher, with this light and that without the objects; the rest met objects whose light is `of`.
Case makeCase(float share, const vec3& with, const vec3& without, const vec3& of)
{
    Case made{};
    made.shown.count = made.catcher.count = 32;
    made.shown.mean = share * with + (1.0F - share) * of;
    made.shown.alpha = 1.0F;
    made.shown.albedo = vec3(0.5F, 0.25F, 0.75F);
    made.catcher.share = share;
    made.catcher.with = share * with;
    made.catcher.without = share * without;
    const PixelMoments composite = compositePixel(made.shown, made.catcher);
    made.mean = composite.mean;
    made.alpha = composite.alpha;
    return made;
}

TEST(CompositeTest, PixelsAreThoseOfTheHost)
{
    const vec3 light(2.0F, 1.0F, 0.5F), red(0.5F, 0.125F, 0.125F);
    struct Known {
        Case made;
        vec3 mean;
        float alpha;
    };
    const Known known[] = {
        {makeCase(0.0F, vec3(0.0F), vec3(0.0F), red), red, 1.0F},                   // an object alone
        {makeCase(1.0F, light, light, vec3(0.0F)), vec3(0.0F), 0.0F},               // a catcher as if nothing were there
        {makeCase(1.0F, 0.25F * light, light, vec3(0.0F)), vec3(0.0F), 0.75F},      // in a shadow
        {makeCase(1.0F, light + red, light, vec3(0.0F)), red, 0.0F},                // brightened: no background is covered
        {makeCase(1.0F, vec3(0.0F), vec3(0.0F), vec3(0.0F)), vec3(0.0F), 0.0F},     // without light
        {makeCase(0.5F, 0.5F * light, light, red), 0.5F * red, 0.5F + 0.5F * 0.5F}  // an edge over a shadow
    };
    std::vector<Case> cases;
    for (const Known& each : known) {
        cases.push_back(each.made);
        EXPECT_NEAR(glm::length(each.made.mean - each.mean), 0.0F, 1e-6F) << cases.size();
        EXPECT_NEAR(each.made.alpha, each.alpha, 1e-6F) << cases.size();
    }
    std::mt19937 random(7);
    std::lognormal_distribution<float> value(-1.0F, 2.0F);
    std::uniform_real_distribution<float> unit;
    for (int i = 0; i < 4096; ++i) {
        const vec3 without(value(random), value(random), value(random)), of(value(random), value(random), value(random));
        const vec3 with = i % 3 == 0 ? without * (1.0F + unit(random)) : without * vec3(unit(random), unit(random), unit(random));
        cases.push_back(makeCase(unit(random), with, without, of));
    }
    KernelTest(test_kernels::composite_test).cases(cases).run();
}

}  // namespace glim::composite_test
