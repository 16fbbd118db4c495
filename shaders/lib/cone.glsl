// The cone of directions in which a sphere is seen.
#ifndef GLIM_LIB_CONE
#define GLIM_LIB_CONE

#include "warp.glsl"

// 1 - cos of the cone's half angle, from the square of its sine: no cancellation however small the cone.
float oneMinusCosCone(float sin2)
{
    return sin2 / (1.0 + sqrt(max(0.0, 1.0 - sin2)));
}

// Uniform in the cone about +z. The sine is computed from 1 - cos, not from cos: accurate to 1e-7 at any size.
vec3 sampleCone(vec2 u, float sin2)
{
    float rise = u.x * oneMinusCosCone(sin2);
    float r = sqrt(max(0.0, rise * (2.0 - rise)));
    return vec3(r * sampleCircle(u.y), 1.0 - rise);
}

// Per steradian.
float pdfCone(float sin2)
{
    return 1.0 / (2.0 * kPi * oneMinusCosCone(sin2));
}

#endif
