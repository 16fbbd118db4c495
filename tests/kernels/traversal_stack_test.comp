// One thread is one traversal of a tree: the children that it meets at each step, and the node group that must come next.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/traversal_stack.glsl"

const uint kSteps = 64u;

struct Step {
    NodeGroup children, group;
    NodeGroup next;  // expected
};

struct Case {
    Step steps[kSteps];
    // Inner children of one node, by place; and their indices among these, in the order in which they must be taken.
    uint inner, octant, count;
    uint order[8];
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { uint results[]; };

void traverse(uint thread)
{
    TraversalStack stack = makeTraversalStack();
    for (uint i = 0u; i < kSteps; ++i) {
        Step step = cases[thread].steps[i];
        NodeGroup next = step.group;
        moveToNextGroup(stack, step.children, next)
        EXPECT_EQUAL(next.first, step.next.first);
        EXPECT_EQUAL(next.left, step.next.left);
        EXPECT_TRUE(hasAny(next) == (step.next.left > 0xffffffu));
    }
}

void takeAll(uint thread)
{
    uint turned = 0u;
    for (uint place = 0u; place < 8u; ++place) {
        turned |= (cases[thread].inner >> place & 1u) << (kFirstNodeBit + (place ^ cases[thread].octant));
    }
    NodeGroup group = NodeGroup(100u, turned | cases[thread].inner);
    for (uint i = 0u; i < cases[thread].count; ++i) {
        EXPECT_TRUE(hasAny(group));
        uint taken = takeNode(group, cases[thread].octant);
        EXPECT_EQUAL(taken, 100u + cases[thread].order[i]);
    }
    EXPECT_TRUE(!hasAny(group));
}

void main()
{
    if (isTestThread()) {
        traverse(TEST_THREAD);
        takeAll(TEST_THREAD);
        results[TEST_THREAD] = 1u;
    }
    endTest();
}
