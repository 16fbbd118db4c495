#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"
#include "shaders/shared/scene_types.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <random>

namespace glim {
namespace {

constexpr uint kSteps = 64;

struct Siblings {
    uint first, left;
};

struct Step {
    Siblings children, siblings, next;
};

struct Case {
    std::array<Step, kSteps> steps;
    uint inner, ahead, count;
    std::array<uint, 8> order;
};

// All different, so that none can stand for another.
class SiblingsMaker {
public:
    explicit SiblingsMaker(uint seed) : random_(seed) {}

    bool decide(double share) { return std::bernoulli_distribution(share)(random_); }
    Siblings any()
    {
        const uint places = std::uniform_int_distribution<uint>(1, 255)(random_);
        return {++made_, places << kFirstNodeBit | places};
    }
    // None is left; which children are inner ones is still there.
    Siblings none() { return {++made_, any().left & 0xffU}; }

private:
    std::mt19937 random_;
    uint made_ = 0;
};

// Never more than `levels` on the stack: the tree is no deeper. Once it is empty, what was popped is nothing.
std::array<Step, kSteps> makeSteps(SiblingsMaker& maker, std::size_t levels, double down)
{
    std::vector<Siblings> stack;
    std::array<Step, kSteps> steps{};
    for (Step& step : steps) {
        const bool children = maker.decide(down), siblings = maker.decide(0.6) && (!children || stack.size() < levels);
        step.children = children ? maker.any() : maker.none();
        step.siblings = siblings ? maker.any() : maker.none();
        step.next = children ? step.children : siblings ? step.siblings : stack.empty() ? Siblings{0, 0} : stack.back();
        if (children && siblings) {
            stack.push_back(step.siblings);
        } else if (!children && !siblings && !stack.empty()) {
            stack.pop_back();
        }
    }
    return steps;
}

// The nearest first: the larger place ^ ahead, the nearer.
void makeOrder(Case& c, uint inner, uint ahead)
{
    c.inner = inner;
    c.ahead = ahead;
    c.count = 0;
    for (uint nearness = 8; nearness-- > 0;) {
        const uint place = nearness ^ ahead;
        if ((inner >> place & 1U) != 0) {
            c.order[c.count++] = static_cast<uint>(std::popcount(inner & ((1U << place) - 1)));
        }
    }
}

TEST(SiblingsTest, TheStackGivesBackWhatWasPutThereLast)
{
    for (const uint levels : {4U, 8U, kMaxStackLevels}) {
        SCOPED_TRACE(std::to_string(levels) + " levels");
        SiblingsMaker maker(levels);
        std::vector<Case> cases(2048);
        for (std::size_t i = 0; i < cases.size(); ++i) {
            cases[i].steps = makeSteps(maker, levels, i % 2 == 0 ? 0.5 : 0.8);
            makeOrder(cases[i], static_cast<uint>(i / 8), static_cast<uint>(i % 8));
        }
        KernelTest test(test_kernels::siblings_test);
        test.specialize(kSpecStackLevels, levels).cases(cases).resultsOf<uint>(cases.size()).run();
    }
}

}  // namespace
}  // namespace glim
