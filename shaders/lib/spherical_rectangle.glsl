// A rectangle as a point sees it: its solid angle, and directions uniform in it. The parametrization is that of Urena, Fajardo and King,
// "An Area-Preserving Parametrization for Spherical Rectangles", 2013: a strip across x, then a point along y. Their formulas measure x by
// angles near the middle of the rectangle's plane. In float32 these angles lose x close to that plane and far from it. So the formulas here
// measure the part of the strip that lies beyond.
#ifndef GLIM_LIB_SPHERICAL_RECTANGLE
#define GLIM_LIB_SPHERICAL_RECTANGLE

#include "portable.glsl"

// In steradians. From here on, samples lie within 3e-4 of the light's size of where they belong: the error is 3e-7 of distance / width, and
// at most 2e-5 in a plane .001 away. There is no largest one.
const float kSmallestSphericalRectangle = 1e-6;

// Relative to the point at its foot in the rectangle's plane.
struct SphericalRectangle {
    vec2 low;          // of the coordinates along the edges
    vec2 size;
    float height;      // of the point, on whichever side
    float solidAngle;  // 0 in the plane, on the rectangle too: no direction to sample
};

// Half the solid angle is the phase of the trace of the product of (1 + sigma.corner) / 2 over unit corners, sigma: Pauli's matrices. With
// three corners that is the formula of Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983. Off by 7e-7 of its size, plus
// 6e-8 of size / distance to the rim (5e-5 over a rim .001 away). The height's own rounding comes on top, 1e-7 of distance / height.
float computeRectangleSolidAngle(vec2 low, vec2 size, float height)
{
    vec2 high = low + size;
    vec2 low2 = low * low;
    vec2 high2 = high * high;
    vec2 across = low * high;
    float height2 = height * height;
    float a = sqrt(low2.x + low2.y + height2);
    float b = sqrt(high2.x + low2.y + height2);
    float c = sqrt(high2.x + high2.y + height2);
    float d = sqrt(low2.x + high2.y + height2);
    float diagonal = across.x + across.y + height2;  // dot product of either pair of opposite corners
    float imaginary = height * (size.x * size.y) * (a + b + c + d);
    float real = (a * b + (across.x + low2.y + height2)) * (c * d + (across.x + high2.y + height2)) +
                 (a * d + (low2.x + across.y + height2)) * (b * c + (high2.x + across.y + height2)) -
                 (a * c - diagonal) * (b * d - diagonal);
    return imaginary > 0.0 ? 2.0 * portableAtan2(imaginary, real) : 0.0;
}

// Of the rectangle of a corner, two unit edges at right angles, and their lengths.
SphericalRectangle makeSphericalRectangle(vec3 p, vec3 corner, vec3 x, vec3 y, float lengthX, float lengthY)
{
    vec3 from = corner - p;
    vec2 low = vec2(dot(from, x), dot(from, y));
    vec2 size = vec2(lengthX, lengthY);
    float height = abs(dot(from, cross(x, y)));
    return SphericalRectangle(low, size, height, computeRectangleSolidAngle(low, size, height));
}

// Whether to measure a share u of [low, high] from its low end: from the end farther from 0, or from the nearer in u if 0 is within. What
// lies beyond that end and up to u is then a sum of positive terms, and at least a quarter of the whole strip if 0 is within.
bool isFromLow(float low, float high, float u)
{
    return low < 0.0 && (high <= 0.0 || u < 0.5);
}

// The share is uniform by solid angle: pdf 1 / solidAngle per steradian. The result is the point, in lengths of the edges.
vec2 sampleSphericalRectangle(SphericalRectangle rectangle, vec2 u)
{
    vec2 low = rectangle.low;
    vec2 high = low + rectangle.size;
    float height2 = rectangle.height * rectangle.height;

    // The strip from x to infinity has the solid angle R, with
    // tan(R/2) = height size.y / (product(x) + inner), product(x) = (x + |x, low.y|) (x + |x, high.y|); |x, y|: distance of that point.
    bool fromLow = isFromLow(low.x, high.x, u.x);
    float x = fromLow ? -low.x : high.x;
    float low2 = low.y * low.y + height2;
    float high2 = high.y * high.y + height2;
    float inner = low.y * high.y + height2;
    float numerator = rectangle.height * rectangle.size.y;
    float denominator = (x + sqrt(x * x + low2)) * (x + sqrt(x * x + high2)) + inner;
    vec2 cosSin = portableCosSin(0.5 * rectangle.solidAngle * (fromLow ? u.x : 1.0 - u.x));
    float product = numerator * (denominator * cosSin.x - numerator * cosSin.y) / (numerator * cosSin.x + denominator * cosSin.y) - inner;
    // product = sqrt(low2 high2) e^(a+b), where x = sqrt(low2) sinh(a) = sqrt(high2) sinh(b).
    float opposite = low2 * high2 / product;
    x = 0.5 * (product - opposite) / sqrt(low2 + high2 + product + opposite);

    // Uniform in y / |x, y|, counted from 1.
    float x2 = x * x + height2;
    bool fromLowY = isFromLow(low.y, high.y, u.y);
    float near = fromLowY ? -high.y : low.y;
    float far = fromLowY ? -low.y : high.y;
    float nearLength = sqrt(x2 + near * near);
    float farLength = sqrt(x2 + far * far);
    float nearGap = x2 / (nearLength * (nearLength + abs(near)));
    float farGap = x2 / (farLength * (farLength + far));
    nearGap = near < 0.0 ? 2.0 - nearGap : nearGap;
    float gap = farGap + (fromLowY ? u.y : 1.0 - u.y) * (nearGap - farGap);
    float y = (1.0 - gap) * sqrt(x2 / (gap * (2.0 - gap)));

    vec2 share = (vec2(fromLow ? -x : x, fromLowY ? -y : y) - low) / rectangle.size;
    return vec2(share.x > 0.0 ? min(share.x, 1.0) : 0.0, share.y > 0.0 ? min(share.y, 1.0) : 0.0);  // NaN gives 0
}

#endif
