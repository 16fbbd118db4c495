#include "host/flatten/flat_scene.hpp"
#include "host/render/kernel_set.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/course_types.h"
#include "shaders/shared/limits.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace glim::features_test {

struct Case {
    FeatureMask features;  // uvec2 on the device: the lower half first
    uint on;
    uint aov, stackLevels, unused = 0;
};

// By default everything that a scene may need is on, and everything that a render may be asked for is off.
constexpr uint kDefaultOn[] = {kSpecSobol};
constexpr uint kDefaultOff[] = {kSpecLens, kSpecChosen, kSpecSuspects, kSpecNotes};

Case defaults()
{
    Case expected{kAllFeatures, 0, kAovRadiance, kMaxStackLevels};
    for (const uint id : kDefaultOn) {
        expected.on |= 1U << id;
    }
    return expected;
}

void expectFeatures(const Case& expected, const Specialization& constants)
{
    KernelTest test(test_kernels::features_test);
    for (const auto& [id, value] : constants) {
        test.specialize(id, value);
    }
    test.cases(std::vector<Case>{expected}).run();
}

TEST(FeaturesTest, EachConstantFollowsItsOwnId)
{
    expectFeatures(defaults(), {});
    for (const uint id : kDefaultOn) {
        SCOPED_TRACE("constant " + std::to_string(id));
        Case expected = defaults();
        expected.on ^= 1U << id;
        expectFeatures(expected, {{id, 0}});
    }
    for (const uint id : kDefaultOff) {
        SCOPED_TRACE("constant " + std::to_string(id));
        Case expected = defaults();
        expected.on ^= 1U << id;
        expectFeatures(expected, {{id, 1}});
    }
}

TEST(FeaturesTest, EachFeatureIsABitOfItsOwn)
{
    FeatureMask seen = 0;
    for (const Feature& feature : kFeatures) {
        SCOPED_TRACE(feature.name);
        EXPECT_TRUE(std::has_single_bit(feature.bit) && (seen & feature.bit) == 0);
        seen |= feature.bit;
    }
    // Of any two bits, some mask has the first without the second: a feature that follows, or also needs, another's bit is noticed.
    for (uint digit = 0; digit < 6; ++digit) {
        FeatureMask mask = 0;
        for (FeatureMask bit = 0; bit < 64; ++bit) {
            mask |= (bit >> digit & 1U) << bit;
        }
        for (const FeatureMask features : {mask, ~mask}) {
            Case expected = defaults();
            expected.features = features;
            expectFeatures(expected, makeConstants(features));
        }
    }
}

TEST(FeaturesTest, EachChoiceFollowsItsOwnId)
{
    for (const uint value : {0U, 1U, 2U, 3U, 4U}) {
        SCOPED_TRACE("value " + std::to_string(value));
        Case aov = defaults(), levels = defaults();
        aov.aov = levels.stackLevels = value;
        expectFeatures(aov, {{kSpecAov, value}});
        expectFeatures(levels, {{kSpecStackLevels, value}});
    }
}

struct CourseCase {
    uint mollerTrumbore, bruteForce, direct, roulette;
};

TEST(FeaturesTest, EachChoiceOfTheCourseFollowsItsOwnId)
{
    const auto expect = [](const CourseCase& expected, const Specialization& constants) {
        KernelTest test(test_kernels::course_features_test);
        for (const auto& [id, value] : constants) {
            test.specialize(id, value);
        }
        test.cases(std::vector<CourseCase>{expected}).run();
    };
    expect({0, 0, kDirectMis, kRouletteThroughput}, {});
    expect({1, 0, kDirectMis, kRouletteThroughput}, {{kSpecMollerTrumbore, 1}});
    expect({0, 1, kDirectMis, kRouletteThroughput}, {{kSpecBruteForce, 1}});
    for (const uint value : {0U, 1U, 2U, 3U}) {
        expect({0, 0, value, kRouletteThroughput}, {{kSpecDirect, value}});
        expect({0, 0, kDirectMis, value}, {{kSpecRoulette, value}});
    }
}

}  // namespace glim::features_test
