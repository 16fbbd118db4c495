// What a traversal has yet to visit.
#ifndef GLIM_ACCESS_SIBLINGS
#define GLIM_ACCESS_SIBLINGS

#include "features.glsl"
#include "shared/scene_types.h"

// Inner children of a node that are yet to be visited: the upper byte of `left`, the nearest uppermost. The lower one says which
// children of the node are inner ones.
struct Siblings {
    uint first;
    uint left;
};

const Siblings kRoot = Siblings(0u, 0x80000000u);
const Siblings kNoSiblings = Siblings(0u, 0u);

bool hasAny(Siblings siblings)
{
    return siblings.left >= 1u << kFirstNodeBit;
}

// Takes the nearest.
uint takeSibling(inout Siblings siblings, uint ahead)
{
    uint bit = uint(findMSB(siblings.left));
    siblings.left &= ~(1u << bit);
    uint place = (bit - kFirstNodeBit) ^ ahead;
    return siblings.first + bitCount(siblings.left & ~(0xffffffffu << place) & 0xffu);
}

// levels[0] is the uppermost, kNoSiblings lie below the last. From kStackLevels on they are not used.
struct SiblingStack {
    Siblings levels[kMaxStackLevels];
};

SiblingStack makeSiblingStack()
{
    SiblingStack stack;
    for (uint i = 0u; i < kStackLevels; ++i) {
        stack.levels[i] = kNoSiblings;
    }
    return stack;
}

Siblings choose(bool first, Siblings a, Siblings b)
{
    return Siblings(first ? a.first : b.first, first ? a.left : b.left);
}

// Where to go on: to the children, to the siblings if there are none, or to what was put on the stack last. Siblings that children
// come before are put there. Every level moves, by selections: to an index of its own, each lane's memory is written for itself.
Siblings nextSiblings(inout SiblingStack stack, Siblings children, Siblings siblings)
{
    bool pushes = hasAny(children) && hasAny(siblings);
    bool pops = !hasAny(children) && !hasAny(siblings);
    Siblings next = choose(hasAny(children), children, choose(pops, stack.levels[0], siblings));
    for (uint i = 0u; i < kStackLevels; ++i) {
        Siblings below = kNoSiblings;
        if (i + 1u < kStackLevels) {
            below = stack.levels[i + 1u];
        }
        stack.levels[i] = choose(pops, below, stack.levels[i]);
    }
    for (uint i = 1u; i < kStackLevels; ++i) {
        uint level = kStackLevels - i;
        stack.levels[level] = choose(pushes, stack.levels[level - 1u], stack.levels[level]);
    }
    stack.levels[0] = choose(pushes, siblings, stack.levels[0]);
    return next;
}

#endif
