// Ray against the boxes of a node's eight children.
#ifndef GLIM_LIB_INTERSECT_NODE
#define GLIM_LIB_INTERSECT_NODE

#include "shared/scene_types.h"

// A plane lies at t = steps * (step / d) + (from - o) / d. Of its rounding the reciprocal has at most 2.5 ulp, the difference and each
// product half a one and the sum half a one of both terms: less than (5 + 4) 2^-24 (|(from - o) / d| + 255 |step / d|), moving
// the offsets by that included.
const float kPlanePad = 6e-7;

// Widens tmax: a box whose contents are met exactly there must not be passed by, or ties between them would depend on the tree.
const float kFarPad = 1.0000009;

// Below this a direction component counts as this: 0 * inf, a NaN, cannot arise.
const float kSmallestDirection = 1e-20;

// Reciprocal direction for hitsOfNode; finite, with the sign of -0 kept.
vec3 reciprocalDirection(vec3 d)
{
    uvec3 sign = floatBitsToUint(d) & 0x80000000u;
    vec3 clamped = max(abs(d), vec3(kSmallestDirection));
    return 1.0 / uintBitsToFloat(floatBitsToUint(clamped) | sign);
}

// Bit k: the ray goes up axis k. A child in place i comes the earlier, the larger i ^ placesAhead is.
uint placesAhead(vec3 reciprocal)
{
    uvec3 up = (floatBitsToUint(reciprocal) >> 31u) ^ 1u;
    return up.x | up.y << 1u | up.z << 2u;
}

// Planes of four children: the nearer ones and the farther ones along the ray.
struct Slabs {
    uvec3 near, far;
};

// Distances of planes are steps * scale + nearOffset or farOffset.
struct Grid {
    vec3 scale, nearOffset, farOffset;
};

Grid makeGrid(uvec4 head, vec3 origin, vec3 reciprocal)
{
    vec3 scale = uintBitsToFloat((uvec3(head.w) >> uvec3(0u, 8u, 16u) & 0xffu) << 23u) * reciprocal;
    vec3 offset = (uintBitsToFloat(head.xyz) - origin) * reciprocal;
    vec3 pad = (abs(offset) + 255.0 * abs(scale)) * kPlanePad;
    return Grid(scale, offset - pad, offset + pad);
}

// Whether the ray meets child number shift / 8 of four. Signed-integer min and max on the bits of floats order every pair of which at
// most one is negative like the floats; with two negatives they may pick the wrong one, which is then still negative and
// loses against 0 (near) or fails the test (far). One instruction each on llvmpipe instead of three.
bool meetsChild(Slabs slabs, uint shift, Grid grid, int last)
{
    ivec3 n = floatBitsToInt(vec3(slabs.near >> shift & 0xffu) * grid.scale + grid.nearOffset);
    ivec3 f = floatBitsToInt(vec3(slabs.far >> shift & 0xffu) * grid.scale + grid.farOffset);
    return max(max(n.x, n.y), max(n.z, 0)) <= min(min(f.x, f.y), min(f.z, last));
}

uint hitsOfFour(Slabs slabs, Grid grid, uint entries, uint ahead, int last)
{
    // All four at once: what to set, and where. Places of nodes (kFirstNodeBit and up) are turned so that the nearest is uppermost.
    uint nodes = (entries & entries << 1u) & 0x10101010u;
    uint places = (entries ^ (nodes >> 4u) * ahead) & 0x1f1f1f1fu;
    uint bits = entries >> 5u & 0x07070707u;
    uint hits = 0u;
    hits |= meetsChild(slabs, 0u, grid, last) ? (bits & 7u) << (places & 31u) : 0u;
    hits |= meetsChild(slabs, 8u, grid, last) ? (bits >> 8u & 7u) << (places >> 8u & 31u) : 0u;
    hits |= meetsChild(slabs, 16u, grid, last) ? (bits >> 16u & 7u) << (places >> 16u & 31u) : 0u;
    hits |= meetsChild(slabs, 24u, grid, last) ? (bits >> 24u) << (places >> 24u) : 0u;
    return hits;
}

// The word of hits of a node (scene_types.h) within [0, tmax], those of inner children in the order of placesAhead.
uint hitsOfNode(uvec4 head, uvec4 content, uvec4 a, uvec4 b, uvec4 c, vec3 origin, vec3 reciprocal, uint ahead, float tmax)
{
    Grid grid = makeGrid(head, origin, reciprocal);
    uvec2 xNear = (ahead & 1u) != 0u ? a.xy : b.zw, xFar = (ahead & 1u) != 0u ? b.zw : a.xy;
    uvec2 yNear = (ahead & 2u) != 0u ? a.zw : c.xy, yFar = (ahead & 2u) != 0u ? c.xy : a.zw;
    uvec2 zNear = (ahead & 4u) != 0u ? b.xy : c.zw, zFar = (ahead & 4u) != 0u ? c.zw : b.xy;
    int last = floatBitsToInt(tmax * kFarPad);
    Slabs first = Slabs(uvec3(xNear.x, yNear.x, zNear.x), uvec3(xFar.x, yFar.x, zFar.x));
    Slabs second = Slabs(uvec3(xNear.y, yNear.y, zNear.y), uvec3(xFar.y, yFar.y, zFar.y));
    return hitsOfFour(first, grid, content.z, ahead, last) | hitsOfFour(second, grid, content.w, ahead, last);
}

#endif
