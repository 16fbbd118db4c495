// Walks the BVH.
#ifndef GLIM_ACCESS_TRAVERSE
#define GLIM_ACCESS_TRAVERSE

#include "lib/infinity.glsl"
#include "lib/intersect_box.glsl"
#include "lib/intersect_sphere.glsl"
#include "lib/intersect_triangle.glsl"
#include "scene.glsl"
#include "shared/limits.h"
#include "shared/path_types.h"

struct Walk {
    vec3 origin;
    vec3 direction;
    vec3 reciprocal;
    Shear shear;
};

Walk beginWalk(vec3 origin, vec3 direction)
{
    return Walk(origin, direction, reciprocalDirection(direction), makeShear(direction));
}

// t in (0, tmax] and barycentrics, or t < 0. A ray never meets the triangle it leaves; a sphere only from within.
TriangleHit intersectRecord(Walk walk, Record record, float tmax, bool isSource)
{
    if (isSphere(record)) {
        float t = intersectSphere(walk.origin, walk.direction, floatsOf(record.t0), uintBitsToFloat(record.t1.x), tmax,
                                  isSource);
        return TriangleHit(t, vec2(0.0));
    }
    if (isSource) {
        return kNoTriangleHit;
    }
    return kMollerTrumbore
               ? intersectMollerTrumbore(walk.origin, walk.direction, floatsOf(record.t0), floatsOf(record.t1),
                                         floatsOf(record.t2), tmax)
               : intersectWatertight(walk.origin, walk.shear, floatsOf(record.t0), floatsOf(record.t1),
                                     floatsOf(record.t2), tmax);
}

// A child to visit: an inner node (count 0) or a leaf.
struct Child {
    uint first, count;
};

// Distances at which the ray enters both children of a node within [0, tmax], < 0 for a miss, nearer one first.
struct Fork {
    Child near, far;
    float nearT, farT;
};

Fork visitNode(Walk walk, uint node, float tmax)
{
    int at = int(node * kNodeTexels);
    uvec4 a = texelFetch(sceneNodes, at);
    uvec4 b = texelFetch(sceneNodes, at + 1);
    uvec4 c = texelFetch(sceneNodes, at + 2);
    uvec4 d = texelFetch(sceneNodes, at + 3);
    float t0 = intersectBox(floatsOf(a), floatsOf(b), walk.origin, walk.reciprocal, tmax);
    float t1 = intersectBox(floatsOf(c), floatsOf(d), walk.origin, walk.reciprocal, tmax);
    Child child0 = Child(a.w, c.w);
    Child child1 = Child(b.w, d.w);
    bool swapped = t0 < 0.0 || (t1 >= 0.0 && t1 < t0);
    return swapped ? Fork(child1, child0, t1, t0) : Fork(child0, child1, t0, t1);
}

struct Closest {
    PathHit hit;
    uint id;  // of its primitive
};

const uint kNoId = 0xffffffffu;

PathHit makeMiss()
{
    return PathHit(kNoRecord, kInfinity, vec2(0.0));
}

// Ties go to the lower primitive id, so that the result does not depend on the tree.
void meetRecord(Walk walk, uint index, uint source, inout Closest best)
{
    Record record = fetchRecord(index);
    TriangleHit hit = intersectRecord(walk, record, best.hit.t, index == source);
    if (hit.t > 0.0 && (hit.t < best.hit.t || record.t0.w < best.id)) {
        best = Closest(PathHit(index, hit.t, hit.barycentric), record.t0.w);
    }
}

// What a traversal has done.
struct Steps {
    uint nodes;       // inner nodes visited, two boxes each
    uint primitives;  // tested
};

PathHit traceClosest(PathRay ray, out Steps steps)
{
    steps = Steps(0u, 0u);
    Walk walk = beginWalk(ray.origin, ray.direction);
    Closest best = Closest(makeMiss(), kNoId);
    Child stack[kMaxBvhDepth];
    uint depth = 0u;
    Child at = Child(0u, 0u);
    bool going = true;
    while (going) {
        bool descend = false;
        if (at.count == 0u) {
            Fork fork = visitNode(walk, at.first, best.hit.t);
            ++steps.nodes;
            descend = fork.nearT >= 0.0;
            at = fork.near;
            if (fork.farT >= 0.0) {
                stack[depth++] = fork.far;
            }
        } else if (at.count != kEmptyLeaf) {
            for (uint i = at.first; i < at.first + at.count; ++i) {
                meetRecord(walk, i, ray.source, best);
                ++steps.primitives;
            }
        }
        if (!descend) {
            going = depth > 0u;
            depth -= going ? 1u : 0u;
            at = stack[depth];
        }
    }
    return best.hit;
}

PathHit traceClosest(PathRay ray)
{
    Steps uncounted;
    return traceClosest(ray, uncounted);
}

// True if nothing but `target` lies between origin and origin + reach * direction.
bool isUnoccluded(ShadowRay ray)
{
    Walk walk = beginWalk(ray.origin, ray.direction);
    Child stack[kMaxBvhDepth];
    uint depth = 0u;
    Child at = Child(0u, 0u);
    bool going = true;
    bool occluded = false;
    while (going) {
        bool descend = false;
        if (at.count == 0u) {
            Fork fork = visitNode(walk, at.first, ray.reach);
            descend = fork.nearT >= 0.0;
            at = fork.near;
            if (fork.farT >= 0.0) {
                stack[depth++] = fork.far;
            }
        } else if (at.count != kEmptyLeaf) {
            for (uint i = at.first; i < at.first + at.count; ++i) {
                TriangleHit hit = intersectRecord(walk, fetchRecord(i), ray.reach, i == ray.source);
                occluded = occluded || (hit.t > 0.0 && i != ray.target);
            }
        }
        if (!descend) {
            going = depth > 0u && !occluded;
            depth -= going ? 1u : 0u;
            at = stack[depth];
        }
    }
    return !occluded;
}

#endif
