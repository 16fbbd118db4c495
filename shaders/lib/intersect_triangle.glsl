// Ray against triangle, watertight.
#ifndef GLIM_LIB_INTERSECT_TRIANGLE
#define GLIM_LIB_INTERSECT_TRIANGLE

#include "intersect_node.glsl"

// Barycentric weights, not normalized: only those of the closest hit are divided by their sum.
struct TriangleHit {
    float t;       // < 0: no hit
    vec2 weights;  // of v1 and v2
    float sum;     // of all three; negative: the ray comes from behind
};

const TriangleHit kNoTriangleHit = TriangleHit(-1.0, vec2(0.0), 1.0);

vec2 computeBarycentric(TriangleHit hit)
{
    return hit.weights / hit.sum;
}

// Which component of a vector goes to an axis: x, y, or, if neither, z.
struct Component {
    bool x, y;
};

// A ray's shear, and the permutation that puts the largest direction component on z. If that component is negative, x and y swap, to keep
// the winding.
struct Shear {
    vec3 s;  // shear x, shear y, scale z
    Component x, y, z;
    vec2 reciprocal;  // of the direction's x and y after the permutation; 0: too small for that
};

float pick(vec3 v, Component component)
{
    return component.x ? v.x : component.y ? v.y : v.z;
}

vec3 permute(vec3 v, Shear shear)
{
    return vec3(pick(v, shear.x), pick(v, shear.y), pick(v, shear.z));
}

Component makeComponent(uint index)
{
    return Component(index == 0u, index == 1u);
}

// `reciprocal`: that of the direction d (intersect_node.glsl).
Shear makeShear(vec3 d, vec3 reciprocal)
{
    vec3 a = abs(d);
    uint z = a.z >= a.x && a.z >= a.y ? 2u : (a.x >= a.y ? 0u : 1u);
    bool flip = pick(d, makeComponent(z)) < 0.0;
    uint next = z == 2u ? 0u : z + 1u;
    uint last = z == 0u ? 2u : z - 1u;
    Shear shear = Shear(vec3(0.0), makeComponent(flip ? last : next), makeComponent(flip ? next : last), makeComponent(z), vec2(0.0));
    vec3 p = permute(d, shear);
    vec3 r = permute(reciprocal, shear);
    shear.s = vec3(p.xy * r.z, r.z);
    shear.reciprocal = vec2(abs(p.x) > kSmallestDirection ? r.x : 0.0, abs(p.y) > kSmallestDirection ? r.y : 0.0);
    return shear;
}

// Upper and lower half of a float's digits, by Veltkamp's constant (Dekker, "A Floating-Point Technique for Extending the Available
// Precision", 1971): products of halves have no rounding error.
struct Halves {
    vec2 upper, lower;
};

Halves halve(vec2 a)
{
    vec2 scaled = 4097.0 * a;
    vec2 upper = scaled - (scaled - a);
    return Halves(upper, a - upper);
}

// x * y - product, exactly, where product is x * y rounded.
float productError(float product, float xUpper, float xLower, float yUpper, float yLower)
{
    return ((xUpper * yUpper - product) + xUpper * yLower + xLower * yUpper) + xLower * yLower;
}

// a.x * b.y - a.y * b.x with the right sign. The relative error is some 2^-23 wherever the result is above 2^-48 of the products.
float crossAccurately(vec2 a, Halves aHalves, vec2 b, Halves bHalves)
{
    float p = a.x * b.y;
    float q = a.y * b.x;
    float pError = productError(p, aHalves.upper.x, aHalves.lower.x, bHalves.upper.y, bHalves.lower.y);
    float qError = productError(q, aHalves.upper.y, aHalves.lower.y, bHalves.upper.x, bHalves.lower.x);
    return (p - q) + (pError - qError);
}

// Twice the signed areas of the triangles that the origin forms with each edge.
vec3 edgeFunctions(vec2 a, vec2 b, vec2 c)
{
    return vec3(c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x);
}

vec3 edgeFunctionsAccurately(vec2 a, vec2 b, vec2 c)
{
    Halves ha = halve(a), hb = halve(b), hc = halve(c);
    return vec3(crossAccurately(c, hc, b, hb), crossAccurately(a, ha, c, hc), crossAccurately(b, hb, a, ha));
}

// Read as signed integers, only positive floats are above 0; read as unsigned integers, only negative floats are above this. Integer minima
// and maxima are one instruction each on a CPU, those of floats three.
const uint kMinusZero = 0x80000000u;

// Some are negative and some are positive.
bool haveBothSigns(vec3 e)
{
    ivec3 i = floatBitsToInt(e);
    uvec3 u = floatBitsToUint(e);
    return max(i.x, max(i.y, i.z)) > 0 && max(u.x, max(u.y, u.z)) > kMinusZero;
}

// All three are on the same side of an axis, and not on it.
bool areBeside(vec2 a, vec2 b, vec2 c)
{
    ivec2 least = min(floatBitsToInt(a), min(floatBitsToInt(b), floatBitsToInt(c)));
    uvec2 most = min(floatBitsToUint(a), min(floatBitsToUint(b), floatBitsToUint(c)));
    return max(least.x, least.y) > 0 || max(most.x, most.y) > kMinusZero;
}

// A coordinate of the vertices, relative to the ray's origin, and the reciprocal of the direction's: t of each vertex is their product.
struct Depths {
    vec3 ofVertices;
    float reciprocal;
};

// Any coordinate's weighted mean over the vertices is the ray's at t. The weights' errors are those of sheared vertices, which mix the
// axes; they move t by the vertices' extent along the chosen axis, divided by the direction there. Woop et al. take the direction's largest
// axis; this takes the least error of the three. So a flat ground along an axis, however large, gives t as if it were small; and the
// error's share along the normal n is at most that of the weights times sum |n_k| extent_k, because min(extent_k / |d_k|) sum |n_k d_k| is.
Depths computeDepths(vec3 a, vec3 b, vec3 c, Shear shear)
{
    vec3 extent = max(abs(b - a), abs(c - a));
    vec3 error = extent * abs(vec3(shear.reciprocal, shear.s.z));
    bool useX = shear.reciprocal.x != 0.0 && error.x < error.z;
    bool useY = shear.reciprocal.y != 0.0 && error.y < (useX ? error.x : error.z);
    vec3 ofVertices = useY ? vec3(a.y, b.y, c.y) : useX ? vec3(a.x, b.x, c.x) : vec3(a.z, b.z, c.z);
    return Depths(ofVertices, useY ? shear.reciprocal.y : useX ? shear.reciprocal.x : shear.s.z);
}

// Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013, without the fallback to double. Rounding is monotone, so
// the sign of a*b - c*d is right or zero; two triangles compute negated values for their common edge; and zero counts as inside. For a ray
// in the triangle's plane but beside the triangle, all three may round to zero. areBeside rejects such rays: they pass outside the
// triangle's box across the ray, which no ray that meets the triangle does. A sliver's edge functions would be rounding noise, hence
// `sliver`; t of a `large` one is taken from the axis that knows it best. Double hits on edges are left to the caller's tie rule. Hits need
// 0 < t <= tMax.
TriangleHit intersectWatertight(vec3 origin, Shear shear, vec3 v0, vec3 v1, vec3 v2, float tMax, bool sliver, bool large)
{
    vec3 a = permute(v0 - origin, shear);
    vec3 b = permute(v1 - origin, shear);
    vec3 c = permute(v2 - origin, shear);
    vec2 pa = a.xy - shear.s.xy * a.z;
    vec2 pb = b.xy - shear.s.xy * b.z;
    vec2 pc = c.xy - shear.s.xy * c.z;
    vec3 e = edgeFunctions(pa, pb, pc);
    if (sliver) {
        e = edgeFunctionsAccurately(pa, pb, pc);
    }
    float det = e.x + e.y + e.z;
    Depths depths = Depths(vec3(a.z, b.z, c.z), shear.s.z);
    if (large) {
        depths = computeDepths(a, b, c, shear);
    }
    float t = -1.0;
    if (!haveBothSigns(e) && !areBeside(pa, pb, pc) && det != 0.0) {  // few: the others need no quotient
        t = depths.reciprocal * (e.x * depths.ofVertices.x + e.y * depths.ofVertices.y + e.z * depths.ofVertices.z) / det;
    }
    return TriangleHit(t > 0.0 && t <= tMax ? t : -1.0, e.yz, det);
}

#endif
