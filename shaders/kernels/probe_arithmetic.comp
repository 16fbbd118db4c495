// One thread is one input. Writes the results of those operations that kernels use and that drivers may round differently (Vulkan,
// "Precision and Operation of SPIR-V Instructions"). None is denormal, which a device may flush.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/arithmetic.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    uint bits = i * 747796405u + 2891336453u;  // of a linear congruential generator
    bits ^= bits >> 16u;
    float unit = float(bits >> 8u) * (1.0 / 16777216.0) + 1e-7;  // above 0, at most 1; films convert no larger integers than this
    float angle = (unit - 0.5) * 12.0;
    float wide = unit * float(1u << (i % 31u));
    uint first = i * kProbedOperations;
    probed[first] = sqrt(wide);
    probed[first + 1u] = unit / (wide + 0.37);
    probed[first + 2u] = length(vec3(unit, angle, wide));
    probed[first + 3u] = unit * angle + wide;
    probed[first + 4u] = mix(angle, wide, unit);
}
