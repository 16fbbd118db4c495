// Latitude-longitude maps: u grows towards +x around the y axis, (0.5, 0.5) is -z, and v = 0 is +y.
#ifndef GLIM_LIB_LAT_LONG
#define GLIM_LIB_LAT_LONG

#include "warp.glsl"

// In [0, pi / 4] for t in [0, 1], off by 1.1e-7 at most; a polynomial in t^2, fitted here, so that all drivers give the same bits. It looks
// directions up in maps, and the one of portableAtan2 measures solid angles: pictures rest on the bits of each, so both stay.
float arcTangent(float t)
{
    float s = t * t;
    float p = 0.00283406419;
    p = p * s - 0.0160050299;
    p = p * s + 0.0425876081;
    p = p * s - 0.0749544576;
    p = p * s + 0.1063675433;
    p = p * s - 0.1420257092;
    p = p * s + 0.1999248415;
    p = p * s - 0.3333306611;
    p = p * s + 1.0;
    return p * t;
}

// The angle of (x, y) from the x axis, in [-pi, pi]; 0 at the origin.
float computeAngle(float y, float x)
{
    float ax = abs(x), ay = abs(y), most = max(ax, ay);
    return unfoldAngle(most > 0.0 ? arcTangent(min(ax, ay) / most) : 0.0, y, x);
}

// In [0, 1]. Accurate at the poles too, where an arc cosine is not.
vec2 latLongFromDirection(vec3 w)
{
    float u = 0.5 + computeAngle(w.x, -w.z) * (0.5 / kPi);
    float v = computeAngle(length(w.xz), w.y) * (1.0 / kPi);
    return vec2(clamp(u, 0.0, 1.0), clamp(v, 0.0, 1.0));
}

// `q` is sin^2 of half the angle from the pole that `lower` names: 1 - |y| = 2 q, without cancellation.
vec3 directionFromLatLong(float u, float q, bool lower)
{
    vec2 circle = sampleCircle(u);
    float sine = 2.0 * sqrt(max(0.0, q * (1.0 - q)));
    float y = 1.0 - 2.0 * q;
    return vec3(circle.y * sine, lower ? -y : y, -circle.x * sine);
}

#endif
