// Warps the unit square to directions and points. Numbers u are in [0, 1).
#ifndef GLIM_LIB_WARP
#define GLIM_LIB_WARP

#include "portable.glsl"

const float kPi = 3.14159265358979;

// The unit disk, area-preserving and concentric. Shirley and Chiu, "A Low Distortion Map Between Disk and Square", 1997.
// pdf 1/pi per unit area.
vec2 sampleDisk(vec2 u)
{
    vec2 p = 2.0 * u - 1.0;
    if (p.x == 0.0 && p.y == 0.0) {
        return vec2(0.0);
    }
    bool wide = abs(p.x) > abs(p.y);
    float radius = wide ? p.x : p.y;
    float quarter = (kPi / 4.0) * ((wide ? p.y : p.x) / radius);
    vec2 turn = portableCosSin(quarter);
    return radius * (wide ? turn : turn.yx);
}

// The hemisphere about +z in proportion to the cosine (Malley's method). z > 0 unless the disk point is on the rim.
vec3 sampleCosineHemisphere(vec2 u)
{
    vec2 disk = sampleDisk(u);
    vec2 square = abs(2.0 * u - 1.0);
    float r = max(square.x, square.y);  // the disk point's radius
    return vec3(disk, sqrt((1.0 - r) * (1.0 + r)));
}

// Per steradian; 0 below the horizon.
float pdfCosineHemisphere(float cosine)
{
    return max(cosine, 0.0) * (1.0 / kPi);
}

// A uniform point of the unit circle, at the angle pi (2 u - 1), within 2e-7. Angles of the left half are folded into the right
// half, exactly.
vec2 sampleCircle(float u)
{
    float halfTurns = 2.0 * u - 1.0;
    bool left = abs(halfTurns) > 0.5;
    vec2 point = portableCosSin(kPi * (left ? sign(halfTurns) - halfTurns : halfTurns));
    return vec2(left ? -point.x : point.x, point.y);
}

// The unit sphere, pdf 1/(4 pi) per steradian.
vec3 sampleSphere(vec2 u)
{
    float z = 1.0 - 2.0 * u.x;
    float r = 2.0 * sqrt(max(0.0, u.x * (1.0 - u.x)));
    return vec3(r * sampleCircle(u.y), z);
}

// Weights of v1 and v2, uniform over a triangle. Osada et al., "Shape Distributions", 2002, folded by Heitz's low-distortion
// map ("A Low-Distortion Map Between Triangle and Square", 2019).
vec2 sampleTriangle(vec2 u)
{
    return u.y > u.x ? vec2(0.5 * u.x, u.y - 0.5 * u.x) : vec2(u.x - 0.5 * u.y, 0.5 * u.y);
}

#endif
