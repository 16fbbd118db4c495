// Ray against triangle, watertight and textbook.
#ifndef GLIM_LIB_INTERSECT_TRIANGLE
#define GLIM_LIB_INTERSECT_TRIANGLE

struct TriangleHit {
    float t;           // < 0: no hit
    vec2 barycentric;  // weights of v1 and v2
};

const TriangleHit kNoTriangleHit = TriangleHit(-1.0, vec2(0.0));

// A ray's shear and axis permutation for the watertight test.
struct Shear {
    vec3 s;     // shear x, shear y, scale z
    uint axis;  // of the largest direction component: 0, 1, 2
    bool flip;  // that component is negative: x and y swap, to keep the winding
};

vec3 permute(vec3 v, uint axis, bool flip)
{
    vec3 p = axis == 2u ? v : axis == 0u ? v.yzx : v.zxy;
    return flip ? p.yxz : p;
}

Shear makeShear(vec3 d)
{
    vec3 a = abs(d);
    uint axis = a.z >= a.x && a.z >= a.y ? 2u : (a.x >= a.y ? 0u : 1u);
    float along = axis == 2u ? d.z : axis == 0u ? d.x : d.y;
    bool flip = along < 0.0;
    vec3 p = permute(d, axis, flip);
    return Shear(vec3(p.x / p.z, p.y / p.z, 1.0 / p.z), axis, flip);
}

// Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013, without the double fallback: rounding is
// monotone, so the sign of a*b - c*d is right or zero, two triangles compute negated values for their common edge, and zero
// counts as inside. So it does for a ray beside the triangle but in its plane, where all three may round to zero: such rays are
// those outside the triangle's box across the ray, which no ray that meets the triangle is. Double hits on edges are left to
// the caller's tie rule. Hits need 0 < t <= tmax.
TriangleHit intersectWatertight(vec3 origin, Shear shear, vec3 v0, vec3 v1, vec3 v2, float tmax)
{
    vec3 a = permute(v0 - origin, shear.axis, shear.flip);
    vec3 b = permute(v1 - origin, shear.axis, shear.flip);
    vec3 c = permute(v2 - origin, shear.axis, shear.flip);
    vec2 pa = a.xy - shear.s.xy * a.z;
    vec2 pb = b.xy - shear.s.xy * b.z;
    vec2 pc = c.xy - shear.s.xy * c.z;
    float u = pc.x * pb.y - pc.y * pb.x;
    float v = pa.x * pc.y - pa.y * pc.x;
    float w = pb.x * pa.y - pb.y * pa.x;
    bool outside = min(u, min(v, w)) < 0.0 && max(u, max(v, w)) > 0.0;
    vec2 low = min(pa, min(pb, pc));
    vec2 high = max(pa, max(pb, pc));
    bool beside = max(low.x, low.y) > 0.0 || min(high.x, high.y) < 0.0;
    float det = u + v + w;
    float t = shear.s.z * (u * a.z + v * b.z + w * c.z) / det;
    bool hit = !outside && !beside && det != 0.0 && t > 0.0 && t <= tmax;
    return hit ? TriangleHit(t, vec2(v, w) / det) : kNoTriangleHit;
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
    return det != 0.0 && inside && t > 0.0 && t <= tmax ? TriangleHit(t, barycentric) : kNoTriangleHit;
}

#endif
