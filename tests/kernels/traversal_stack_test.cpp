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

namespace glim::traversal_stack_test {

constexpr uint kSteps = 64;

struct NodeGroup {
    uint first, left;
};

struct Step {
    NodeGroup children, group, next;
};

struct Case {
    std::array<Step, kSteps> steps;
    uint inner, octant, count;
    std::array<uint, 8> order;
};

// All different, so that none can be taken for another.
class NodeGroupMaker {
public:
    explicit NodeGroupMaker(uint seed)
        : random_(seed)
    {}

    bool decide(double share) { return std::bernoulli_distribution(share)(random_); }
    NodeGroup any()
    {
        const uint places = std::uniform_int_distribution<uint>(1, 255)(random_);
        return {++made_, places << kFirstNodeBit | places};
    }
    // None is left; which children are inner ones is still there.
    NodeGroup none() { return {++made_, any().left & 0xffU}; }

private:
    std::mt19937 random_;
    uint made_ = 0;
};

// Never more than `levels` on the stack: the tree is no deeper. Once it is empty, what was popped is nothing.
std::array<Step, kSteps> makeSteps(NodeGroupMaker& maker, std::size_t levels, double down)
{
    std::vector<NodeGroup> stack;
    std::array<Step, kSteps> steps{};
    for (Step& step : steps) {
        const bool children = maker.decide(down), group = maker.decide(0.6) && (!children || stack.size() < levels);
        step.children = children ? maker.any() : maker.none();
        step.group = group ? maker.any() : maker.none();
        step.next = children ? step.children : group ? step.group : stack.empty() ? NodeGroup{0, 0} : stack.back();
        if (children && group) {
            stack.push_back(step.group);
        } else if (!children && !group && !stack.empty()) {
            stack.pop_back();
        }
    }
    return steps;
}

// The nearest first: the larger place ^ octant is, the nearer the child.
void makeOrder(Case& c, uint inner, uint octant)
{
    c.inner = inner;
    c.octant = octant;
    c.count = 0;
    for (uint nearness = 8; nearness-- > 0;) {
        const uint place = nearness ^ octant;
        if ((inner >> place & 1U) != 0) {
            c.order[c.count++] = static_cast<uint>(std::popcount(inner & ((1U << place) - 1)));
        }
    }
}

TEST(TraversalStackTest, TheStackGivesBackWhatWasPutThereLast)
{
    for (const uint levels : {4U, 8U, kMaxStackLevels}) {
        SCOPED_TRACE(std::to_string(levels) + " levels");
        NodeGroupMaker maker(levels);
        std::vector<Case> cases(2048);
        for (std::size_t i = 0; i < cases.size(); ++i) {
            cases[i].steps = makeSteps(maker, levels, i % 2 == 0 ? 0.5 : 0.8);
            makeOrder(cases[i], static_cast<uint>(i / 8), static_cast<uint>(i % 8));
        }
        for (const bool shared : {false, true}) {
            KernelTest test(test_kernels::traversal_stack_test);
            test.specialize(kSpecStackLevels, levels).specialize(kSpecSharedStack, shared);
            test.cases(cases).resultsOf<uint>(cases.size()).run();
        }
    }
}

}  // namespace glim::traversal_stack_test
