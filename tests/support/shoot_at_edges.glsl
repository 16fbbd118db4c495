// One ray from inside a closed convex mesh: at an edge, at a vertex, or along an axis at an edge. Include expect.glsl and a traverse.glsl
// before.
#ifndef GLIM_TESTS_SHOOT_AT_EDGES
#define GLIM_TESTS_SHOOT_AT_EDGES

#include "lib/hash.glsl"
#include "lib/frame.glsl"

struct Setup {
    vec3 center;
    float scale;
    float tolerance;  // of the distance to the surface
    float noise;      // rounding of the test's edge functions, relative to the squared distance of the vertices
};

struct Tally {
    uint rays[3];
    uint misses[3];
    uint astray[3];  // hits that are not where the ray was aimed
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Setup setup; };
layout(set = 0, binding = kBindResults, scalar) buffer Results { Tally tally; };

// Half of the lengths are left as they come: then an aim at a vertex is often exact.
vec3 aim(vec3 from, vec3 to, bool normalized)
{
    return normalized ? normalizeSafely(to - from) : to - from;
}

// How far the rounding of the barycentrics may move the hit along a thin triangle.
float slackOn(uint index, vec3 origin, vec3 direction)
{
    PrimitiveRef ref = fetchPrimitiveRef(index);
    vec3 a = toFloats(ref.t1) - toFloats(ref.t0);
    vec3 b = toFloats(ref.t2) - toFloats(ref.t0);
    vec3 reach = max(abs(toFloats(ref.t1) - origin), abs(toFloats(ref.t2) - origin));
    float seen = abs(dot(cross(a, b), normalizeSafely(direction)));
    return setup.noise * dot(reach, reach) / seen * max(length(a), length(b));
}

// Returns what the ray has met.
PathHit shootRay()
{
    uint kind = TEST_THREAD % 3u;
    uvec4 a = hash4(uvec4(TEST_THREAD, 0u, 0u, render.seed));
    uvec4 b = hash4(uvec4(TEST_THREAD, 1u, 0u, render.seed));
    PrimitiveRef ref = fetchPrimitiveRef(chooseBin(a.x, uint(textureSize(scenePrimitiveRefs)) / kPrimitiveRefTexels));
    vec3 v0 = toFloats(ref.t0);
    vec3 target = kind == 1u ? v0 : v0 + (toFloats(ref.t1) - v0) * (0.05 + 0.9 * unitFloat(a.y));
    vec3 origin = setup.center + setup.scale * 0.3 * (1.0 - 2.0 * vec3(unitFloat(b.xy), unitFloat(b.z)));
    if (kind == 2u) {
        vec3 d = abs(target - setup.center);
        vec3 axis = d.x >= d.y && d.x >= d.z ? vec3(1, 0, 0) : d.y >= d.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
        vec3 beside = mix(target, setup.center, axis);
        origin = length(beside - setup.center) < 0.9 * setup.scale ? beside : origin;
    }
    vec3 direction = aim(origin, target, (b.w & 1u) != 0u);
    PathHit hit = traceClosest(PathRay(origin, kNoPrimitive, direction, 0u));
    atomicAdd(tally.rays[kind], 1u);
    if (hit.primitiveRef == kNoPrimitiveRef) {
        atomicAdd(tally.misses[kind], 1u);
    } else if (!(abs(hit.t * length(direction) - length(target - origin)) <=
                 setup.tolerance + slackOn(hit.primitiveRef, origin, direction))) {
        atomicAdd(tally.astray[kind], 1u);
    }
    return hit;
}

#endif
