// Rays through cards of known coverage: what they meet and what is left of them can be calculated.
#include "test_kernels.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/scene_on_device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace glim::transparency_test {

struct Case {
    vec3 origin;
    uint source;
    vec3 direction;
    uint target;
    float tMax;
    uint sides = 1;  // kFronts
};

struct Result {
    uint met;
    vec3 weight;
    vec3 clear;
};

struct Card {
    float x, alpha;
};

// Each card is two triangles, primitives 2 i and 2 i + 1. Cards 2 and 3 lie in one plane.
constexpr Card kCards[] = {{1.0F, 0.25F}, {2.0F, 0.5F}, {3.0F, 0.5F}, {3.0F, 0.75F}, {4.0F, 0.1F}, {5.0F, 1.0F}};
constexpr std::size_t kCardCount = std::size(kCards);

Scene cards()
{
    SceneBuilder builder;
    for (const Card& card : kCards) {
        const auto material = builder.lambert(glm::vec3(0.5F), glm::vec3(0.0F), true);
        builder.quad({glm::vec3(card.x, -1, -1), {card.x, 1, -1}, {card.x, 1, 1}, {card.x, -1, 1}}, material);
    }
    builder.environment(glm::vec3(1.0F));
    Scene scene = builder.scene();
    for (std::size_t i = 0; i < kCardCount; ++i) {
        if (kCards[i].alpha < 1.0F) {
            scene.materials[scene.meshes[i].material].alphaMode = AlphaMode::Blend;
            scene.materials[scene.meshes[i].material].alpha = kCards[i].alpha;
        }
    }
    return scene;
}

// The card whose triangle a primitive is.
std::size_t cardOf(uint primitive) { return primitive / 2; }

const Case kThrough{{0, 0.3F, 0.1F}, kNoPrimitive, {1, 0, 0}, kNoPrimitive, 4.5F};

std::vector<Result> trace(const std::vector<Case>& cases, const Scene& of = cards())
{
    const SceneOnDevice scene(of);
    KernelTest test = scene.test(test_kernels::transparency_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

float clearOf(const Case& c) { return trace({c})[0].clear.x; }

TEST(TransparencyTest, ARayMeetsEachCardAsOftenAsItsCoverage)
{
    constexpr std::size_t kRays = 1 << 16;
    std::vector<std::size_t> met(kCardCount);
    for (const Result& result : trace(std::vector<Case>(kRays, kThrough))) {
        ASSERT_NE(result.met, kNoPrimitive);
        ++met[cardOf(result.met)];
        EXPECT_EQ(result.weight, vec3(1.0F));
    }
    double left = 1.0;
    for (std::size_t i = 0; i < kCardCount; ++i) {
        const double alpha = static_cast<double>(kCards[i].alpha), expected = left * alpha;
        const double z = (static_cast<double>(met[i]) - kRays * expected) / std::sqrt(kRays * expected * (1.0 - expected));
        EXPECT_LT(std::abs(z), 4.56) << "card " << i;
        left *= 1.0 - alpha;
    }
}

TEST(TransparencyTest, AShadowRayIsDimmedByEachCard)
{
    // Up to x = 4.5; .5 and .75 share a plane.
    EXPECT_FLOAT_EQ(clearOf(kThrough), 0.75F * 0.5F * 0.5F * 0.25F * 0.9F);
    Case shorter = kThrough;
    shorter.tMax = 2.5F;
    EXPECT_FLOAT_EQ(clearOf(shorter), 0.75F * 0.5F);
    Case longer = kThrough;
    longer.tMax = 6.0F;
    EXPECT_EQ(clearOf(longer), 0.0F);
    // An unnormalised direction: tMax counts its lengths.
    Case doubled = shorter;
    doubled.direction = vec3(2, 0, 0);
    doubled.tMax = 1.25F;
    EXPECT_EQ(clearOf(doubled), clearOf(shorter));
}

// The light that the ray aims at does not dim it, nor the card that it leaves; a card in the plane of either does.
TEST(TransparencyTest, SourceAndTargetDoNotCount)
{
    const uint half = kThrough.origin.y > kThrough.origin.z ? 0 : 1;  // the triangle of each card that the ray passes
    Case aimed = kThrough;
    for (const uint card : {2U, 3U}) {
        aimed.target = 2 * card + half;
        EXPECT_FLOAT_EQ(clearOf(aimed), 0.75F * 0.5F * (card == 2 ? 0.25F : 0.5F) * 0.9F) << "card " << card;
    }
    Case leaving = kThrough;
    leaving.origin.x = 1.0F;
    leaving.tMax = 1.5F;
    leaving.source = half;
    EXPECT_FLOAT_EQ(clearOf(leaving), 0.5F);
}

// A card and a ball, which are objects, then a lamp and a shadow catcher.
Scene objectsBeforeACatcher(bool alpha)
{
    SceneBuilder builder;
    const auto quad = [&builder](float x, std::uint32_t material) {
        builder.quad({glm::vec3(x, -1, -1), {x, 1, -1}, {x, 1, 1}, {x, -1, 1}}, material);
    };
    Material card = makeLambert(glm::vec3(0.5F), glm::vec3(0.0F), true), catcher = card;
    card.alphaMode = alpha ? AlphaMode::Blend : AlphaMode::Opaque;
    card.alpha = 0.5F;
    catcher.isCatcher = true;
    quad(1.0F, builder.add(card));
    quad(4.0F, builder.lambert(glm::vec3(0.5F), glm::vec3(1.0F), true));
    quad(5.0F, builder.add(catcher));
    builder.sphere({2.0F, 0.2F, 0.0F}, 0.5F, builder.lambert(glm::vec3(0.5F)));
    return builder.scene();
}

TEST(TransparencyTest, RaysWithoutObjectsMeetLampsAndCatchersAlone)
{
    constexpr uint kAll = 1, kWithout = 5;  // kFronts, and kWithoutObjects
    constexpr uint kLamp = 2, kCatcher = 4, kBall = 6;
    for (const bool alpha : {false, true}) {
        const Case all{{0, 0.3F, 0.1F}, kNoPrimitive, {1, 0, 0}, kNoPrimitive, 3.5F, kAll};
        Case without = all, farther = all, within = all, behind = all;
        without.sides = farther.sides = within.sides = behind.sides = kWithout;
        farther.tMax = 4.5F;                 // past the lamp
        within.origin = {2.0F, 0.2F, 0.0F};  // of the ball
        within.source = kBall;
        behind.origin.x = 4.5F;
        const std::vector<Result> results = trace({all, without, farther, within, behind}, objectsBeforeACatcher(alpha));
        EXPECT_LT(results[0].met == kBall ? 0 : results[0].met, kLamp);
        EXPECT_EQ(results[0].clear, vec3(0.0F));
        EXPECT_EQ(results[1].met & ~1U, kLamp);
        EXPECT_EQ(results[1].clear, vec3(1.0F));
        EXPECT_EQ(results[2].clear, vec3(0.0F));
        EXPECT_EQ(results[3].met & ~1U, kLamp);
        EXPECT_EQ(results[4].met & ~1U, kCatcher);
    }
}

}  // namespace glim::transparency_test
