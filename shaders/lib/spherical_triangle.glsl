// A triangle as a point sees it: its solid angle, and directions uniform in it. The parametrization is that of Arvo, "Stratified Sampling
// of Spherical Triangles", 1995: a smaller triangle on one edge, then a point of an arc. Here the parametrization is solved from Van
// Oosterom and Strackee's formula, without the triangle's angles, which lose small triangles in float32.
#ifndef GLIM_LIB_SPHERICAL_TRIANGLE
#define GLIM_LIB_SPHERICAL_TRIANGLE

#include "portable.glsl"

// In steradians. No limit of accuracy: from 1e-13 sr on, samples lie within 7e-7 of the light's size of where they belong, except close to
// the plane (sampleSphericalTriangle). Smaller lights look flat, and samples by area do as well. There is no largest one.
const float kSmallestSphericalTriangle = 1e-8;

struct SphericalTriangle {
    vec3 v0;  // relative to the point
    vec3 e1, e2;
    float numerator, denominator;  // of tan(solidAngle / 2)
    float solidAngle;              // 0 in the plane, on the triangle too: no direction to sample
};

// Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983, with the numerator from the edges. Off by 1e-6 of its size, plus
// 8e-8 of size / distance to the rim (8e-5 over a rim .001 away). The height's own rounding comes on top, 1e-7 of distance / height, and more
// in slivers.
SphericalTriangle makeSphericalTriangle(vec3 p, vec3 v0, vec3 e1, vec3 e2)
{
    vec3 a = v0 - p;
    vec3 b = a + e1;
    vec3 c = a + e2;
    float lengthA = length(a);
    float lengthB = length(b);
    float lengthC = length(c);
    float numerator = abs(dot(a, cross(e1, e2)));
    float denominator = lengthA * lengthB * lengthC + dot(a, b) * lengthC + dot(b, c) * lengthA + dot(a, c) * lengthB;
    return SphericalTriangle(a, e1, e2, numerator, denominator, numerator > 0.0 ? 2.0 * portableAtan2(numerator, denominator) : 0.0);
}

float square(vec3 v)
{
    return dot(v, v);
}

// NaN gives 0.
float clampShare(float share)
{
    return share > 0.0 ? min(share, 1.0) : 0.0;
}

// Weights of v1 and v2, uniform by solid angle: pdf 1 / solidAngle per steradian. In a plane .001 away the distribution is off by 2e-4, over
// the rim by 4e-4.
vec2 sampleSphericalTriangle(SphericalTriangle triangle, vec2 u)
{
    vec3 a = triangle.v0;
    vec3 b = a + triangle.e1;
    float lengthA = length(a);
    float lengthB = length(b);

    // The triangle a, b, a + share e2 has the solid angle R = u.x solidAngle, with
    // cot(R/2) numerator = side (|a + share e2| + |a|) / share + lengthA dot(b, e2) + lengthB dot(a, e2), side = lengthA lengthB + dot(a, b).
    // Cosine and sine of R/2 are not normalised. They come from the nearer end: none cancels, and the angle is at most pi/2.
    bool fromWhole = u.x >= 0.5;
    vec2 cosSin = portableCosSin(0.5 * triangle.solidAngle * (fromWhole ? 1.0 - u.x : u.x));
    vec2 whole = vec2(triangle.denominator, triangle.numerator);
    cosSin = fromWhole ? vec2(dot(whole, cosSin), whole.y * cosSin.x - whole.x * cosSin.y) : cosSin;
    float cotangent = triangle.numerator * cosSin.x;
    // Squared, by the law of cosines: share = ratio ((lengthA + along) / (1 - ratio length) + (lengthA - along) / (1 + ratio length)), where
    // ratio = share / (|a + share e2| + |a|), and along is a's part along e2. What cancels over an edge is replaced by a cross product.
    float product = dot(a, b);
    float side = product < 0.0 ? square(cross(a, triangle.e1)) / (lengthA * lengthB - product) : lengthA * lengthB + product;
    float lengthE2 = length(triangle.e2);
    float along = dot(a, triangle.e2) / lengthE2;
    float large = lengthA + abs(along);
    float small = square(cross(a, triangle.e2)) / (lengthE2 * lengthE2 * large);
    float before = along < 0.0 ? small : large;  // lengthA + along
    float behind = along < 0.0 ? large : small;
    float minus = cotangent - cosSin.y * (lengthB * lengthE2 * before + dot(b, lengthA * triangle.e2 + lengthE2 * a));
    float plus = cotangent + cosSin.y * (lengthB * lengthE2 * behind - dot(b, lengthA * triangle.e2 - lengthE2 * a));
    float share = side * cosSin.y * (before / minus + behind / plus);
    share = minus > 0.0 && plus > 0.0 ? clampShare(share) : 1.0;

    // The arc from b to c, uniform in 1 - cos(angle from b).
    vec3 c = a + share * triangle.e2;
    vec3 edge = c - b;
    float normal2 = square(cross(b, edge));
    float lengths = lengthB * length(c);
    product = dot(b, c);
    large = lengths + abs(product);
    small = normal2 / large;
    float rise = (product > 0.0 ? small : large) / lengths;  // 1 - cos of the whole arc
    float fall = (product > 0.0 ? large : small) / lengths;  // 1 + cos
    float sampledRise = u.y * rise;
    float sampledFall = fall + (1.0 - u.y) * rise;
    float sine = sqrt(sampledRise * sampledFall);
    float cosine = 0.5 * (sampledFall - sampledRise);
    float denominator = sqrt(normal2) * cosine - dot(b, edge) * sine;
    float arc = denominator > 0.0 ? clampShare(lengthB * lengthB * sine / denominator) : 1.0;
    return vec2(1.0 - arc, arc * share);
}

#endif
