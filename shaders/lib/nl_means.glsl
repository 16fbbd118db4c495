// Non-local means: how similar two noisy pixels are. Rousselle, Knaus, Zwicker, "Adaptive Rendering with Non-Local Means Filtering", 2012,
// section 4.
#ifndef GLIM_LIB_NL_MEANS
#define GLIM_LIB_NL_MEANS

#include "portable.glsl"

// The smaller, the fewer pixels are alike.
const float kSimilarity = 0.5;

// Keeps what is constant but for rounding alike: the square of 1e-5 of the picture's mean.
const float kMinVariance = 1e-10;

// The squared difference of two means in units of their noise, less what noise alone gives, but of B's noise no more than A's. Where the
// radiance is the same, it is 0 on average if B has no more noise than A, and above 0 if it has more. The mean of the three channels.
float pixelDistance(vec3 meanA, vec3 varianceA, vec3 meanB, vec3 varianceB)
{
    vec3 difference = meanA - meanB;
    vec3 excess = difference * difference - (varianceA + min(varianceA, varianceB));
    vec3 distance = excess / (kMinVariance + (kSimilarity * kSimilarity) * (varianceA + varianceB));
    return (distance.x + distance.y + distance.z) * (1.0 / 3.0);
}

// The weight of a pixel whose patch differs by so much on average.
float patchWeight(float meanDistance)
{
    return portableExp(-max(meanDistance, 0.0));
}

// Without what is about as small as denormal numbers, which devices may flush: it would be all the radiance of a black pixel beside bright
// ones.
vec3 weightedRadiance(vec3 mean, float weight)
{
    vec3 weighted = mean * weight;
    return mix(vec3(0.0), weighted, greaterThan(abs(weighted), vec3(1e-37)));
}

#endif
