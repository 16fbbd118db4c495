// What a traversal has yet to visit.
#ifndef GLIM_ACCESS_TRAVERSAL_STACK
#define GLIM_ACCESS_TRAVERSAL_STACK

#include "features.glsl"
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

// levels[0] is the top; kEmptyGroup lie below the last entry. Only the first kStackLevels levels are used.
struct TraversalStack {
    NodeGroup levels[kMaxStackLevels];
};

TraversalStack makeTraversalStack()
{
    TraversalStack stack;
    for (uint i = 0u; i < kStackLevels; ++i) {
        stack.levels[i] = kEmptyGroup;
    }
    return stack;
}

NodeGroup choose(bool first, NodeGroup a, NodeGroup b)
{
    return NodeGroup(first ? a.first : b.first, first ? a.left : b.left);
}

// The group to visit next: the children; if there are none, the rest of `group`; if that is empty too, the top of the stack. If there are
// children, the rest of `group` is pushed. Every level moves, by selections: with an index of its own, each lane would write to memory by
// itself.
NodeGroup nextGroup(inout TraversalStack stack, NodeGroup children, NodeGroup group)
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

// If the children are those of an instance: what comes after them, which is the rest of `group` or else the top of the stack, leaves it.
void markWayBack(inout TraversalStack stack, NodeGroup children, inout NodeGroup group)
{
    bool enters = (children.left & kEntersInstance) != 0u;
    group.left |= enters && hasAny(group) ? kLeavesInstance : 0u;
    stack.levels[0].left |= enters && !hasAny(group) ? kLeavesInstance : 0u;
}

#endif
