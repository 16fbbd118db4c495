// What a traversal has yet to visit.
#ifndef GLIM_ACCESS_TRAVERSAL_STACK
#define GLIM_ACCESS_TRAVERSAL_STACK

#include "features.glsl"
#include "pass.glsl"
#include "shared/scene_types.h"

// Inner children of a node that are still to be visited: the upper byte of `left`, the nearest uppermost. The lowest byte says which
// children of the node are inner ones.
struct NodeGroup {
    uint first;
    uint left;
};

const NodeGroup kRootGroup = NodeGroup(0u, 0x80000000u);
const NodeGroup kEmptyGroup = NodeGroup(0u, 0u);

// Further bits of `left`: the group is the root of an instance's mesh; or it is the first one to visit after an instance.
const uint kEntersInstance = 0x100u;
const uint kLeavesInstance = 0x200u;

bool hasAny(NodeGroup group)
{
    return group.left >= 1u << kFirstNodeBit;
}

// Takes the nearest child of the group.
uint takeNode(inout NodeGroup group, uint octant)
{
    uint bit = uint(findMSB(group.left));
    group.left &= ~(1u << bit);
    uint place = (bit - kFirstNodeBit) ^ octant;
    return group.first + bitCount(group.left & ~(0xffffffffu << place) & 0xffu);
}

// A GPU's workgroup has its stacks in shared memory, level by level. Registers have no index there: moving all levels, as below, would take
// two registers a level, and an array in a thread's own memory more (tests/bench/GPU.md).
const uint kSharedGroups = kSharedStack ? kStackLevels * gl_WorkGroupSize.x : 1u;
shared uint sharedFirst[kSharedGroups], sharedLeft[kSharedGroups];
#define SHARED_PLACE(level) ((level) * gl_WorkGroupSize.x + gl_LocalInvocationID.x)

// levels[0] is the top; kEmptyGroup lie below the last entry. Only the first kStackLevels levels are used. In shared memory the top is
// level depth - 1.
struct TraversalStack {
    NodeGroup levels[kMaxStackLevels];
    uint depth;
};

TraversalStack makeTraversalStack()
{
    TraversalStack stack;
    stack.depth = 0u;
    if (!kSharedStack) {
        for (uint i = 0u; i < kStackLevels; ++i) {
            stack.levels[i] = kEmptyGroup;
        }
    }
    return stack;
}

NodeGroup choose(bool first, NodeGroup a, NodeGroup b)
{
    return NodeGroup(first ? a.first : b.first, first ? a.left : b.left);
}

// Every level moves, by selections: with an index of its own, each lane of a CPU's vector would write to memory by itself.
NodeGroup selectNextGroup(inout TraversalStack stack, NodeGroup children, NodeGroup group)
{
    bool pushes = hasAny(children) && hasAny(group);
    bool pops = !hasAny(children) && !hasAny(group);
    NodeGroup next = choose(hasAny(children), children, choose(pops, stack.levels[0], group));
    for (uint i = 0u; i < kStackLevels; ++i) {
        NodeGroup below = kEmptyGroup;
        if (i + 1u < kStackLevels) {
            below = stack.levels[i + 1u];
        }
        stack.levels[i] = choose(pops, below, stack.levels[i]);
    }
    for (uint i = 1u; i < kStackLevels; ++i) {
        uint level = kStackLevels - i;
        stack.levels[level] = choose(pushes, stack.levels[level - 1u], stack.levels[level]);
    }
    stack.levels[0] = choose(pushes, group, stack.levels[0]);
    return next;
}

// Sets `group` to the group to visit next: the children; if there are none, the rest of `group`; if that is empty too, the top of the
// stack. If there are children, the rest of `group` is pushed.
#define moveToNextGroup(stack, children, group) \
    { \
        if (kSharedStack) { \
            if (hasAny(children)) { \
                if (hasAny(group)) { \
                    sharedFirst[SHARED_PLACE(stack.depth)] = group.first; \
                    sharedLeft[SHARED_PLACE(stack.depth)] = group.left; \
                    ++stack.depth; \
                } \
                group = children; \
            } else if (!hasAny(group)) { \
                group = kEmptyGroup; \
                if (stack.depth > 0u) { \
                    --stack.depth; \
                    group = NodeGroup(sharedFirst[SHARED_PLACE(stack.depth)], sharedLeft[SHARED_PLACE(stack.depth)]); \
                } \
            } \
        } else { \
            group = selectNextGroup(stack, children, group); \
        } \
    }

// If the children are those of an instance: what comes after them, which is the rest of `group` or else the top of the stack, leaves it.
#define markWayBack(stack, children, group) \
    { \
        bool enters = (children.left & kEntersInstance) != 0u; \
        group.left |= enters && hasAny(group) ? kLeavesInstance : 0u; \
        if (kSharedStack) { \
            if (enters && !hasAny(group)) { \
                if (stack.depth == 0u) { \
                    sharedFirst[SHARED_PLACE(0u)] = 0u; \
                    sharedLeft[SHARED_PLACE(0u)] = 0u; \
                    stack.depth = 1u; \
                } \
                sharedLeft[SHARED_PLACE(stack.depth - 1u)] |= kLeavesInstance; \
            } \
        } else { \
            stack.levels[0].left |= enters && !hasAny(group) ? kLeavesInstance : 0u; \
        } \
    }

#endif
