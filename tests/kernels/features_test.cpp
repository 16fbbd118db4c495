#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

struct Case {
    uint on;
    uint direct, roulette, view, stackLevels;
};

// Unasked, all that a scene may need is on, and what a render may be asked for is off.
constexpr uint kDefaultOn[] = {kSpecSpheres,        kSpecSlivers,      kSpecSmooth,         kSpecMirrors,     kSpecGlasses,
                               kSpecTriangleLights, kSpecSphereLights, kSpecPunctualLights, kSpecEnvironment, kSpecSobol};
constexpr uint kDefaultOff[] = {kSpecMollerTrumbore, kSpecBruteForce, kSpecLens, kSpecChosen,
                                kSpecSuspects,       kSpecNotes,      kSpecLuminance};

Case defaults()
{
    Case expected{0, kDirectMis, kRouletteThroughput, kViewNormal, kMaxStackLevels};
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

TEST(FeaturesTest, EachChoiceFollowsItsOwnId)
{
    for (const uint value : {0U, 1U, 2U, 3U, 4U}) {
        SCOPED_TRACE("value " + std::to_string(value));
        Case direct = defaults(), roulette = defaults(), view = defaults(), levels = defaults();
        direct.direct = roulette.roulette = view.view = levels.stackLevels = value;
        expectFeatures(direct, {{kSpecDirect, value}});
        expectFeatures(roulette, {{kSpecRoulette, value}});
        expectFeatures(view, {{kSpecView, value}});
        expectFeatures(levels, {{kSpecStackLevels, value}});
    }
}

}  // namespace
}  // namespace glim
