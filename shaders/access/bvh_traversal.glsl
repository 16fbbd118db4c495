// Traverses the BVH. The including file defines intersectTriangle: traverse.glsl does, and course/traverse.glsl for the course.
#ifndef GLIM_ACCESS_BVH_TRAVERSAL
#define GLIM_ACCESS_BVH_TRAVERSAL

#include "lib/finite.glsl"
#include "lib/intersect_capsule.glsl"
#include "lib/intersect_node.glsl"
#include "lib/intersect_sphere.glsl"
#include "lib/intersect_triangle.glsl"
#include "scene.glsl"
#include "traversal_stack.glsl"
#include "shared/path_types.h"

struct TraversalRay {
    vec3 origin;
    vec3 direction;
    vec3 reciprocal;
    uint octant;  // rayOctant
    Shear shear;
};

TraversalRay makeTraversalRay(vec3 origin, vec3 direction)
{
    vec3 reciprocal = reciprocalDirection(direction);
    return TraversalRay(origin, direction, reciprocal, rayOctant(reciprocal), makeShear(direction, reciprocal));
}

TriangleHit intersectTriangle(TraversalRay traversal, PrimitiveRef ref, float tMax);

float intersectSphere(TraversalRay traversal, PrimitiveRef ref, float tMax, bool isSource)
{
    if (isLine(ref)) {
        return intersectCapsule(traversal.origin, traversal.direction, toFloats(ref.t0), toFloats(ref.t1), uintBitsToFloat(ref.t2.x), tMax,
                                isSource);
    }
    return intersectSphere(traversal.origin, traversal.direction, toFloats(ref.t0), uintBitsToFloat(ref.t1.x), tMax, isSource);
}

// The sides from which a query meets single-sided surfaces: the fronts if its rays go as those of a path from the camera, the backs if they
// go the other way. A path from a light meets both (light_traversal.glsl).
const uint kFronts = 1u;
const uint kBacks = 2u;
// With them: rays pass what has kObjectBit (catcher.glsl).
const uint kWithoutObjects = 4u;

#define sidesAlone(sides) (hasFeature(kFeatureCatcher) ? (sides) & (kFronts | kBacks) : (sides))
#define passesObject(ref, sides) \
    (hasFeature(kFeatureCatcher) && ((ref).t1.w & kObjectBit) != 0u && ((sides) & kWithoutObjects) != 0u)

// The far side, which a ray meets from within, if the near one does not count.
float intersectSphere(TraversalRay traversal, PrimitiveRef ref, float tMax, bool isSource, uint sides)
{
    float t = intersectSphere(traversal, ref, tMax, isSource);
    if (isSingleSided(ref) && sides != (kFronts | kBacks)) {
        vec3 p = traversal.origin + t * traversal.direction;
        bool fromWithin = dot(p - sphereCenter(ref, p), traversal.direction) > 0.0;
        if (sides == kBacks && !fromWithin) {
            t = intersectSphere(traversal, ref, tMax, true);
        }
        t = sides == kFronts && fromWithin ? -1.0 : t;
    }
    return t;
}

// t in (0, tMax] and barycentrics, or t < 0. A ray never meets the triangle it leaves; a sphere only from within. An instance that mirrors
// leaves the sides as they are: a mirrored front stays the front.
TriangleHit intersectShape(TraversalRay traversal, PrimitiveRef ref, float tMax, bool isSource, uint sides)
{
    if (passesObject(ref, sides)) {
        return kNoTriangleHit;
    }
    sides = sidesAlone(sides);
    if (isSphere(ref)) {
        return TriangleHit(intersectSphere(traversal, ref, tMax, isSource, sides), vec2(0.0), 1.0);
    }
    TriangleHit hit = kNoTriangleHit;
    if (!isSource) {
        hit = intersectTriangle(traversal, ref, tMax);
    }
    if (isSingleSided(ref) && (sides & (hit.sum < 0.0 ? kBacks : kFronts)) == 0u) {
        hit.t = -1.0;
    }
    return hit;
}

TriangleHit intersectShape(TraversalRay traversal, PrimitiveRef ref, float tMax, bool isSource)
{
    return intersectShape(traversal, ref, tMax, isSource, kFronts);
}

// Leaf references that are still to be tested: bit i of `left` stands for reference first + i.
struct PrimitiveRefs {
    uint first;
    uint left;
};

uint takePrimitiveRef(inout PrimitiveRefs refs)
{
    uint bit = uint(findLSB(refs.left));
    refs.left &= refs.left - 1u;
    return refs.first + bit;
}

const uint kNodeBits = 0xffffffffu << kFirstNodeBit;

void visitNode(TraversalRay traversal, uint node, float tMax, out NodeGroup children, out PrimitiveRefs refs)
{
    int at = int(node * kNodeTexels);
    uvec4 head = texelFetch(sceneNodes, at);
    uvec4 content = texelFetch(sceneNodes, at + 1);
    uint hits = intersectChildren(head, content, texelFetch(sceneNodes, at + 2), texelFetch(sceneNodes, at + 3), texelFetch(sceneNodes,
                                                                                                                            at + 4),
                                  traversal.origin, traversal.reciprocal, traversal.octant, tMax);
    children = NodeGroup(content.x, (hits & kNodeBits) | head.w >> 24u);
    if (hasFeature(kFeatureInstances)) {
        bool isInstance = (content.z | content.w) == 0u;
        children.left = isInstance ? kRootGroup.left | kEntersInstance : children.left;
    }
    refs = PrimitiveRefs(content.y, hits & ~kNodeBits);
}

// What leads from the mesh that is traversed to the instance: to be added to its references and primitive ids. 0 outside instances.
struct InstanceOffsets {
    uint primitiveRef;
    uint primitive;
};

const InstanceOffsets kNoOffsets = InstanceOffsets(0u, 0u);

// Where the next group enters or leaves the instance `node`, the ray changes its space. Its direction is not made unit, so t stays what it
// is. All triangles of an instance see the same bits of the ray: within it, the tests stay watertight.
void changeSpace(vec3 origin, vec3 direction, uint node, inout NodeGroup group, inout TraversalRay traversal, inout InstanceOffsets offsets)
{
    if ((group.left & (kEntersInstance | kLeavesInstance)) != 0u) {
        offsets = kNoOffsets;
        if ((group.left & kEntersInstance) != 0u) {
            int at = int(node * kNodeTexels);
            vec4 x = uintBitsToFloat(texelFetch(sceneNodes, at));
            vec4 y = uintBitsToFloat(texelFetch(sceneNodes, at + 2));
            vec4 z = uintBitsToFloat(texelFetch(sceneNodes, at + 3));
            uvec4 data = texelFetch(sceneNodes, at + 4);
            offsets = InstanceOffsets(data.x, data.y);
            if (hasFeature(kFeatureMotion) && data.z != 0u) {
                Movement movement = movementNow(data.z);
                origin = takePointBack(movement, origin);
                direction = takeVectorBack(movement, direction);
            } else {
                origin = vec3(dot(x.xyz, origin) + x.w, dot(y.xyz, origin) + y.w, dot(z.xyz, origin) + z.w);
                direction = vec3(dot(x.xyz, direction), dot(y.xyz, direction), dot(z.xyz, direction));
            }
        }
        traversal = makeTraversalRay(origin, direction);
        group.left &= ~(kEntersInstance | kLeavesInstance);
    }
}

struct Closest {
    uint primitiveRef;
    uint primitive;
    TriangleHit hit;
};

Closest makeMiss()
{
    return Closest(kNoPrimitiveRef, kNoPrimitive, TriangleHit(kInfinity, vec2(0.0), 1.0));
}

PathHit makePathHit(Closest best)
{
    return PathHit(best.primitiveRef, best.hit.t, computeBarycentric(best.hit));
}

// What a query for the closest hit looks for. Hits are ordered by t, then by primitive: this order does not depend on the tree, and with
// it a ray can go on behind a hit without an offset.
struct Query {
    float tMax;
    float afterT;          // only hits after this one
    uint afterPrimitive;
    uint target;           // not this primitive
    bool alphaOnly;        // only references with alpha
    uint sides;            // of single-sided surfaces
};

Query unrestrictedQuery() { return Query(kInfinity, 0.0, kNoPrimitive, kNoPrimitive, false, kFronts); }

bool isAfter(Query query, float t, uint primitive)
{
    return t > query.afterT || (t == query.afterT && primitive > query.afterPrimitive);
}

// Whether the query may be one that goes on behind a hit.
#define mayContinue(query) \
    (hasFeature(kFeatureAlpha | kFeatureMedia) || (hasFeature(kFeatureSingleSided) && (query).sides == (kFronts | kBacks)))

// Ties go to the lower primitive, so that the result does not depend on the tree.
void intersectPrimitive(TraversalRay traversal, InstanceOffsets offsets, uint index, uint source, Query query, inout Closest best)
{
    PrimitiveRef ref = fetchPrimitiveRef(index);
    uint primitive = getPrimitive(ref) + offsets.primitive;
    TriangleHit hit = intersectShape(traversal, ref, best.hit.t, primitive == source, query.sides);
    bool counts = true;
    if (mayContinue(query)) {
        if (isSphere(ref) && !isAfter(query, hit.t, primitive) && !passesObject(ref, query.sides)) {
            hit = TriangleHit(intersectSphere(traversal, ref, best.hit.t, true, sidesAlone(query.sides)), vec2(0.0), 1.0);  // the far side
        }
        counts = isAfter(query, hit.t, primitive) && primitive != query.target && (hasAlpha(ref) || !query.alphaOnly);
    }
    if (counts && hit.t > 0.0 && (hit.t < best.hit.t || primitive < best.primitive)) {
        best = Closest(index + offsets.primitiveRef, primitive, hit);
    }
}

void intersectPrimitive(TraversalRay traversal, uint index, uint source, inout Closest best)
{
    intersectPrimitive(traversal, kNoOffsets, index, source, unrestrictedQuery(), best);
}

// What a traversal has done.
struct Steps {
    uint nodes;       // visited, eight boxes each
    uint primitives;  // tested
};

// Loops test their condition at the end. If they test it at the beginning, a CPU runs the body once more with no lane active. But the code
// after such a loop may use only variables that the loop carries from iteration to iteration: some drivers recompute anything else for a
// lane that has left, as long as other lanes stay, from variables that may have changed since (driver_bugs.md, KernelRulesTest).
PathHit traceClosest(PathRay ray, Query query, inout Steps steps)
{
    TraversalRay traversal = makeTraversalRay(ray.origin, ray.direction);
    Closest best = makeMiss();
    best.hit.t = query.tMax;
    TraversalStack stack = makeTraversalStack();
    NodeGroup group = kRootGroup;
    InstanceOffsets offsets = kNoOffsets;
    do {
        uint node = takeNode(group, traversal.octant);
        NodeGroup children;
        PrimitiveRefs refs;
        visitNode(traversal, node, best.hit.t, children, refs);
        ++steps.nodes;
        if (refs.left != 0u) {
            do {
                intersectPrimitive(traversal, offsets, takePrimitiveRef(refs), ray.source, query, best);
                ++steps.primitives;
            } while (refs.left != 0u);
        }
        if (hasFeature(kFeatureInstances)) {
            markWayBack(stack, children, group)
        }
        moveToNextGroup(stack, children, group)
        if (hasFeature(kFeatureInstances)) {
            changeSpace(ray.origin, ray.direction, node, group, traversal, offsets);
        }
    } while (hasAny(group));
    return makePathHit(best);
}

PathHit traceClosest(PathRay ray)
{
    Steps uncounted = Steps(0u, 0u);
    return traceClosest(ray, unrestrictedQuery(), uncounted);
}

// True if nothing but `target` and references with alpha lies between origin and origin + tMax * direction. `metAlpha`: some of these did.
// `sides`: of single-sided surfaces.
bool isUnoccluded(ShadowRay ray, uint sides, inout Steps steps, out bool metAlpha)
{
    metAlpha = false;
    TraversalRay traversal = makeTraversalRay(ray.origin, ray.direction);
    TraversalStack stack = makeTraversalStack();
    NodeGroup group = kRootGroup;
    InstanceOffsets offsets = kNoOffsets;
    bool going = true;
    bool occluded = false;
    do {
        uint node = takeNode(group, traversal.octant);
        NodeGroup children;
        PrimitiveRefs refs;
        visitNode(traversal, node, ray.tMax, children, refs);
        ++steps.nodes;
        if (hasFeature(kFeatureInstances)) {
            markWayBack(stack, children, group)
        }
        moveToNextGroup(stack, children, group)
        going = hasAny(group);
        if (refs.left != 0u) {
            do {
                PrimitiveRef ref = fetchPrimitiveRef(takePrimitiveRef(refs));
                uint primitive = getPrimitive(ref) + offsets.primitive;
                TriangleHit hit = intersectShape(traversal, ref, ray.tMax, primitive == ray.source, sides);
                ++steps.primitives;
                bool met = hit.t > 0.0 && primitive != ray.target;
                if (hasFeature(kFeatureAlpha)) {
                    metAlpha = metAlpha || (met && hasAlpha(ref));
                    met = met && !hasAlpha(ref);
                }
                occluded = occluded || met;
                going = going && !met;
                refs.left = met ? 0u : refs.left;
            } while (refs.left != 0u);
        }
        if (hasFeature(kFeatureInstances)) {
            changeSpace(ray.origin, ray.direction, node, group, traversal, offsets);
        }
    } while (going);
    return !occluded;
}

bool isUnoccluded(ShadowRay ray)
{
    Steps uncounted = Steps(0u, 0u);
    bool metAlpha;
    return isUnoccluded(ray, kFronts, uncounted, metAlpha);
}

#endif
