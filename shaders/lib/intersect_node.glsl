// Ray against the boxes of a node's eight children.
#ifndef GLIM_LIB_INTERSECT_NODE
#define GLIM_LIB_INTERSECT_NODE

#include "shared/scene_types.h"

// The ray meets a plane at t = steps * (step / d) + (from - o) / d. Rounding errors: at most 2.5 ulp from the reciprocal, half an ulp from
// the difference and from each product, and half an ulp of both terms from the sum. Together, including the rounding of the padded offsets,
// they are less than (5 + 4) 2^-24 (|(from - o) / d| + 255 |step / d|).
const float kPlanePad = 6e-7;

// Widens tMax. A box whose contents the ray meets exactly at tMax must not be skipped, or ties would depend on the tree.
const float kFarPad = 1.0000009;

// Smaller direction components are replaced by this, so that 0 * inf, a NaN, cannot arise.
const float kSmallestDirection = 1e-20;

// Reciprocal direction for intersectChildren; finite, with the sign of -0 kept.
vec3 reciprocalDirection(vec3 d)
{
    uvec3 sign = floatBitsToUint(d) & 0x80000000u;
    vec3 clamped = max(abs(d), vec3(kSmallestDirection));
    return 1.0 / uintBitsToFloat(floatBitsToUint(clamped) | sign);
}

// Bit k is set if the ray goes up axis k. The larger i ^ rayOctant, the earlier the ray reaches the child in place i.
uint rayOctant(vec3 reciprocal)
{
    uvec3 up = (floatBitsToUint(reciprocal) >> 31u) ^ 1u;
    return up.x | up.y << 1u | up.z << 2u;
}

// The near and the far planes of four children along the ray, one byte per child.
struct Slabs {
    uvec3 near, far;
};

// The ray meets a plane at t = steps * scale + nearOffset or farOffset.
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

// Whether the ray meets child number shift / 8 of four. Signed integer min and max of the floats' bits take one instruction each on
// a CPU instead of three. They order two floats correctly unless both are negative. Then they may pick the wrong one, but that is
// negative too: it loses against 0 (near) or fails the test (far).
bool meetsChild(Slabs slabs, uint shift, Grid grid, int last)
{
    ivec3 n = floatBitsToInt(vec3(slabs.near >> shift & 0xffu) * grid.scale + grid.nearOffset);
    ivec3 f = floatBitsToInt(vec3(slabs.far >> shift & 0xffu) * grid.scale + grid.farOffset);
    return max(max(n.x, n.y), max(n.z, 0)) <= min(min(f.x, f.y), min(f.z, last));
}

uint intersectFourChildren(Slabs slabs, Grid grid, uint entries, uint octant, int last)
{
    // For all four at once: which bits to set, and where. Places of inner children (kFirstNodeBit and up) are permuted so that the nearest
    // is uppermost.
    uint nodes = (entries & entries << 1u) & 0x10101010u;
    uint places = (entries ^ (nodes >> 4u) * octant) & 0x1f1f1f1fu;
    uint bits = entries >> 5u & 0x07070707u;
    uint hits = 0u;
    hits |= meetsChild(slabs, 0u, grid, last) ? (bits & 7u) << (places & 31u) : 0u;
    hits |= meetsChild(slabs, 8u, grid, last) ? (bits >> 8u & 7u) << (places >> 8u & 31u) : 0u;
    hits |= meetsChild(slabs, 16u, grid, last) ? (bits >> 16u & 7u) << (places >> 16u & 31u) : 0u;
    hits |= meetsChild(slabs, 24u, grid, last) ? (bits >> 24u) << (places >> 24u) : 0u;
    return hits;
}

// The word of hits of a node (scene_types.h) within [0, tMax]. The bits of inner children are in the order of rayOctant.
uint intersectChildren(uvec4 head, uvec4 content, uvec4 a, uvec4 b, uvec4 c, vec3 origin, vec3 reciprocal, uint octant, float tMax)
{
    Grid grid = makeGrid(head, origin, reciprocal);
    uvec2 xNear = (octant & 1u) != 0u ? a.xy : b.zw, xFar = (octant & 1u) != 0u ? b.zw : a.xy;
    uvec2 yNear = (octant & 2u) != 0u ? a.zw : c.xy, yFar = (octant & 2u) != 0u ? c.xy : a.zw;
    uvec2 zNear = (octant & 4u) != 0u ? b.xy : c.zw, zFar = (octant & 4u) != 0u ? c.zw : b.xy;
    int last = floatBitsToInt(tMax * kFarPad);
    Slabs first = Slabs(uvec3(xNear.x, yNear.x, zNear.x), uvec3(xFar.x, yFar.x, zFar.x));
    Slabs second = Slabs(uvec3(xNear.y, yNear.y, zNear.y), uvec3(xFar.y, yFar.y, zFar.y));
    return intersectFourChildren(first, grid, content.z, octant, last) | intersectFourChildren(second, grid, content.w, octant, last);
}

#endif
