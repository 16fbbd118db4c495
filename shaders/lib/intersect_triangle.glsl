// Ray against triangle, watertight and textbook.
#ifndef GLIM_LIB_INTERSECT_TRIANGLE
#define GLIM_LIB_INTERSECT_TRIANGLE

// Weights are divided by their sum once, of the hit that counts.
struct TriangleHit {
    float t;       // < 0: no hit
    vec2 weights;  // of v1 and v2
    float sum;     // of all three
};

const TriangleHit kNoTriangleHit = TriangleHit(-1.0, vec2(0.0), 1.0);

vec2 barycentricOf(TriangleHit hit)
{
    return hit.weights / hit.sum;
}

// Which component of a vector stands on an axis: its x, its y, or neither.
struct Source {
    bool x, y;
};

// A ray's shear and the permutation that puts the largest direction component on z; x and y swap where it is negative, to keep the
// winding.
struct Shear {
    vec3 s;  // shear x, shear y, scale z
    Source x, y, z;
};

float pick(vec3 v, Source source)
{
    return source.x ? v.x : source.y ? v.y : v.z;
}

vec3 permute(vec3 v, Shear shear)
{
    return vec3(pick(v, shear.x), pick(v, shear.y), pick(v, shear.z));
}

Source sourceOf(uint component)
{
    return Source(component == 0u, component == 1u);
}

Shear makeShear(vec3 d)
{
    vec3 a = abs(d);
    uint z = a.z >= a.x && a.z >= a.y ? 2u : (a.x >= a.y ? 0u : 1u);
    bool flip = pick(d, sourceOf(z)) < 0.0;
    uint next = z == 2u ? 0u : z + 1u;
    uint last = z == 0u ? 2u : z - 1u;
    Shear shear = Shear(vec3(0.0), sourceOf(flip ? last : next), sourceOf(flip ? next : last), sourceOf(z));
    vec3 p = permute(d, shear);
    shear.s = vec3(p.x / p.z, p.y / p.z, 1.0 / p.z);
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

// a.x * b.y - a.y * b.x with its right sign, and to some 2^-23 of itself wherever it is above 2^-48 of the products.
float crossAccurately(vec2 a, Halves aHalves, vec2 b, Halves bHalves)
{
    float p = a.x * b.y;
    float q = a.y * b.x;
    float pError = productError(p, aHalves.upper.x, aHalves.lower.x, bHalves.upper.y, bHalves.lower.y);
    float qError = productError(q, aHalves.upper.y, aHalves.lower.y, bHalves.upper.x, bHalves.lower.x);
    return (p - q) + (pError - qError);
}

// Twice the signed areas of the origin with each edge.
vec3 edgeFunctions(vec2 a, vec2 b, vec2 c)
{
    return vec3(c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x);
}

vec3 edgeFunctionsAccurately(vec2 a, vec2 b, vec2 c)
{
    Halves ha = halve(a), hb = halve(b), hc = halve(c);
    return vec3(crossAccurately(c, hc, b, hb), crossAccurately(a, ha, c, hc), crossAccurately(b, hb, a, ha));
}

// The bits of floats as integers: only positive ones are above 0, and as unsigned integers only negative ones are above this. Integer
// minima and maxima are one instruction each on llvmpipe, those of floats three.
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

// Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013, without the double fallback: rounding is
// monotone, so the sign of a*b - c*d is right or zero, two triangles compute negated values for their common edge, and zero
// counts as inside. So it does for a ray beside the triangle but in its plane, where all three may round to zero: such rays are
// those outside the triangle's box across the ray, which no ray that meets the triangle is. A sliver's edge functions would be
// rounding noise, hence `sliver`. Double hits on edges are left to the caller's tie rule. Hits need 0 < t <= tmax.
TriangleHit intersectWatertight(vec3 origin, Shear shear, vec3 v0, vec3 v1, vec3 v2, float tmax, bool sliver)
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
    float t = shear.s.z * (e.x * a.z + e.y * b.z + e.z * c.z) / det;
    bool hit = !haveBothSigns(e) && !areBeside(pa, pb, pc) && det != 0.0 && t > 0.0 && t <= tmax;
    return TriangleHit(hit ? t : -1.0, e.yz, det);
}

// Moller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997, for comparison: it leaks at edges.
TriangleHit intersectMollerTrumbore(vec3 origin, vec3 direction, vec3 v0, vec3 v1, vec3 v2, float tmax)
{
    vec3 e1 = v1 - v0;
    vec3 e2 = v2 - v0;
    vec3 p = cross(direction, e2);
    float det = dot(e1, p);
    vec3 s = origin - v0;
    vec3 q = cross(s, e1);
    vec2 barycentric = vec2(dot(s, p), dot(direction, q)) / det;
    float t = dot(e2, q) / det;
    bool inside = barycentric.x >= 0.0 && barycentric.y >= 0.0 && barycentric.x + barycentric.y <= 1.0;
    return det != 0.0 && inside && t > 0.0 && t <= tmax ? TriangleHit(t, barycentric, 1.0) : kNoTriangleHit;
}

#endif
