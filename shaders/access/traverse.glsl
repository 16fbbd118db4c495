// Walks the BVH.
#ifndef GLIM_ACCESS_TRAVERSE
#define GLIM_ACCESS_TRAVERSE

#include "lib/infinity.glsl"
#include "lib/intersect_node.glsl"
#include "lib/intersect_sphere.glsl"
#include "lib/intersect_triangle.glsl"
#include "scene.glsl"
#include "siblings.glsl"
#include "shared/path_types.h"

struct Walk {
    vec3 origin;
    vec3 direction;
    vec3 reciprocal;
    uint ahead;  // placesAhead
    Shear shear;
};

Walk beginWalk(vec3 origin, vec3 direction)
{
    vec3 reciprocal = reciprocalDirection(direction);
    return Walk(origin, direction, reciprocal, placesAhead(reciprocal), makeShear(direction));
}

// t in (0, tmax] and barycentrics, or t < 0. A ray never meets the triangle it leaves; a sphere only from within.
TriangleHit intersectRecord(Walk walk, Record record, float tmax, bool isSource)
{
    if (isSphere(record)) {
        float t = intersectSphere(walk.origin, walk.direction, floatsOf(record.t0), uintBitsToFloat(record.t1.x), tmax,
                                  isSource);
        return TriangleHit(t, vec2(0.0), 1.0);
    }
    if (isSource) {
        return kNoTriangleHit;
    }
    return kMollerTrumbore
               ? intersectMollerTrumbore(walk.origin, walk.direction, floatsOf(record.t0), floatsOf(record.t1),
                                         floatsOf(record.t2), tmax)
               : intersectWatertight(walk.origin, walk.shear, floatsOf(record.t0), floatsOf(record.t1),
                                     floatsOf(record.t2), tmax, isSliver(record));
}

// Leaves' records that are yet to be tested: bits of `left`, from `first` on.
struct Records {
    uint first;
    uint left;
};

uint takeRecord(inout Records records)
{
    uint bit = uint(findLSB(records.left));
    records.left &= records.left - 1u;
    return records.first + bit;
}

const uint kNodeBits = 0xffffffffu << kFirstNodeBit;

void visitNode(Walk walk, uint node, float tmax, out Siblings children, out Records records)
{
    int at = int(node * kNodeTexels);
    uvec4 head = texelFetch(sceneNodes, at);
    uvec4 content = texelFetch(sceneNodes, at + 1);
    uint hits = hitsOfNode(head, content, texelFetch(sceneNodes, at + 2), texelFetch(sceneNodes, at + 3), texelFetch(sceneNodes, at + 4),
                           walk.origin, walk.reciprocal, walk.ahead, tmax);
    children = Siblings(content.x, (hits & kNodeBits) | head.w >> 24u);
    records = Records(content.y, hits & ~kNodeBits);
}

struct Closest {
    uint record;
    uint primitive;
    TriangleHit hit;
};

Closest makeMiss()
{
    return Closest(kNoRecord, kNoPrimitive, TriangleHit(kInfinity, vec2(0.0), 1.0));
}

PathHit hitOf(Closest best)
{
    return PathHit(best.record, best.hit.t, barycentricOf(best.hit));
}

// Ties go to the lower primitive, so that the result does not depend on the tree.
void meetRecord(Walk walk, uint index, uint source, inout Closest best)
{
    Record record = fetchRecord(index);
    TriangleHit hit = intersectRecord(walk, record, best.hit.t, primitiveOf(record) == source);
    if (hit.t > 0.0 && (hit.t < best.hit.t || primitiveOf(record) < best.primitive)) {
        best = Closest(index, primitiveOf(record), hit);
    }
}

// What a traversal has done.
struct Steps {
    uint nodes;       // visited, eight boxes each
    uint primitives;  // tested
};

// Loops are tested at their end: tested at its beginning, a loop on llvmpipe goes through its body once more, for no lane at all. But
// what such a loop hands to what follows, it must carry from round to round: on Mesa 22.3.6 whatever else a lane has when it leaves is
// computed anew as long as others stay, from variables that have moved on.
PathHit traceClosest(PathRay ray, out Steps steps)
{
    steps = Steps(0u, 0u);
    Walk walk = beginWalk(ray.origin, ray.direction);
    Closest best = makeMiss();
    SiblingStack stack = makeSiblingStack();
    Siblings siblings = kRoot;
    do {
        uint node = takeSibling(siblings, walk.ahead);
        Siblings children;
        Records records;
        visitNode(walk, node, best.hit.t, children, records);
        ++steps.nodes;
        if (records.left != 0u) {
            do {
                meetRecord(walk, takeRecord(records), ray.source, best);
                ++steps.primitives;
            } while (records.left != 0u);
        }
        siblings = nextSiblings(stack, children, siblings);
    } while (hasAny(siblings));
    return hitOf(best);
}

PathHit traceClosest(PathRay ray)
{
    Steps uncounted;
    return traceClosest(ray, uncounted);
}

// True if nothing but `target` lies between origin and origin + reach * direction.
bool isUnoccluded(ShadowRay ray, out Steps steps)
{
    steps = Steps(0u, 0u);
    Walk walk = beginWalk(ray.origin, ray.direction);
    SiblingStack stack = makeSiblingStack();
    Siblings siblings = kRoot;
    bool going = true;
    bool occluded = false;
    do {
        uint node = takeSibling(siblings, walk.ahead);
        Siblings children;
        Records records;
        visitNode(walk, node, ray.reach, children, records);
        ++steps.nodes;
        siblings = nextSiblings(stack, children, siblings);
        going = hasAny(siblings);
        if (records.left != 0u) {
            do {
                Record record = fetchRecord(takeRecord(records));
                TriangleHit hit = intersectRecord(walk, record, ray.reach, primitiveOf(record) == ray.source);
                ++steps.primitives;
                bool met = hit.t > 0.0 && primitiveOf(record) != ray.target;
                occluded = occluded || met;
                going = going && !met;
                records.left = met ? 0u : records.left;
            } while (records.left != 0u);
        }
    } while (going);
    return !occluded;
}

bool isUnoccluded(ShadowRay ray)
{
    Steps uncounted;
    return isUnoccluded(ray, uncounted);
}

#endif
