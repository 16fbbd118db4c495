// Ray against axis-aligned box.
#ifndef GLIM_LIB_INTERSECT_BOX
#define GLIM_LIB_INTERSECT_BOX

// Widens the far end by the rounding of two divisions of 2.5 ulp and their products (Ize, "Robust BVH Ray Traversal", JCGT
// 2(2), 2013, has 2 ulp for exact division): (2 * 2.5 + 2) * 2^-24, twice. Of tmax too: a box whose contents are met exactly
// at tmax must not be passed by, or ties between them would depend on the tree.
const float kFarPad = 1.0000009;

// Below this a direction component counts as this: 0 * inf, a NaN, cannot arise.
const float kSmallestDirection = 1e-20;

// Reciprocal direction for intersectBox; finite, with the sign of -0 kept.
vec3 reciprocalDirection(vec3 d)
{
    uvec3 sign = floatBitsToUint(d) & 0x80000000u;
    vec3 clamped = max(abs(d), vec3(kSmallestDirection));
    return 1.0 / uintBitsToFloat(floatBitsToUint(clamped) | sign);
}

// Where the ray enters the box within [0, tmax], or -1. Signed-integer min and max on the bits of floats order every pair of
// which at most one is negative like the floats; with two negatives they may pick the wrong one, which is then still
// negative and loses against 0 (near) or fails the test (far). One instruction each on llvmpipe instead of three.
// Boxes must have a thickness: the far plane of a flat one would tie with the near one at t = 0 (flatten_scene.cpp).
float intersectBox(vec3 lo, vec3 hi, vec3 origin, vec3 reciprocal, float tmax)
{
    ivec3 a = floatBitsToInt((lo - origin) * reciprocal);
    ivec3 b = floatBitsToInt((hi - origin) * reciprocal);
    ivec3 n = min(a, b);
    ivec3 f = max(a, b);
    int near = max(max(n.x, n.y), max(n.z, 0));
    float last = intBitsToFloat(min(min(f.x, floatBitsToInt(tmax)), min(f.y, f.z))) * kFarPad;
    return near <= floatBitsToInt(last) ? intBitsToFloat(near) : -1.0;
}

#endif
