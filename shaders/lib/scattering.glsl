// Scattering in a homogeneous medium whose extinction differs from channel to channel: how far light goes, and where to.
#ifndef GLIM_LIB_SCATTERING
#define GLIM_LIB_SCATTERING

#include "finite.glsl"
#include "frame.glsl"
#include "portable.glsl"
#include "warp.glsl"

vec3 exponential(vec3 x)
{
    return vec3(portableExp(x.r), portableExp(x.g), portableExp(x.b));
}

float sumOfChannels(vec3 v) { return v.r + v.g + v.b; }

// The channel that u falls to, each in proportion to its throughput. By these probabilities, and the balance heuristic over the channels
// (Wilkie et al., "Hero Wavelength Spectral Sampling", 2014), the sum of the channels' throughputs stays the same but for the albedo,
// however much their extinctions differ.
uint chooseChannel(vec3 throughput, float u)
{
    float at = u * sumOfChannels(throughput);
    return at < throughput.r ? 0u : at < throughput.r + throughput.g || !(throughput.b > 0.0) ? 1u : 2u;
}

// The distance to the next scattering, in metres, by the extinction of one channel. Infinite without any.
float sampleFreePath(float extinction, float u)
{
    return extinction > 0.0 ? (0.0 - portableLog2(1.0 - u)) * 0.69314718056 / extinction : kInfinity;
}

// The throughput where the light scatters after t metres.
vec3 scatteredThroughput(vec3 throughput, vec3 extinction, vec3 albedo, float t)
{
    vec3 density = throughput * extinction * exponential(-extinction * t);
    return density * albedo * (sumOfChannels(throughput) / sumOfChannels(density));
}

// The throughput where the light reaches a surface after t metres.
vec3 reachedThroughput(vec3 throughput, vec3 extinction, float t)
{
    vec3 left = throughput * exponential(-extinction * min(t, 1e30));
    return left * (sumOfChannels(throughput) / sumOfChannels(left));
}

// The cosine of a deflection with the mean g: Henyey and Greenstein, "Diffuse Radiation in the Galaxy", 1941. Its usual inverse
// (1 + g^2 - s^2) / (2 g) is written so that nothing cancels and g may be 0.
float sampleDeflection(float g, float u)
{
    float x = 2.0 * u - 1.0;
    float s = (1.0 - g * g) / (1.0 + g * x);
    return 0.5 * (g + (x + g) * (1.0 + s) / (1.0 + g * x));
}

// Their density per steradian, by the cosine. The square is (1 - abs(g))^2 or more; 1e-8 keeps rounding from making it 0 or negative.
float pdfOfDeflection(float g, float cosine)
{
    float square = max(1.0 + g * g - 2.0 * g * cosine, 1e-8);
    return 0.0795774715 * (1.0 - g * g) / (square * sqrt(square));
}

vec3 deflect(vec3 direction, float g, vec2 u)
{
    float z = clamp(sampleDeflection(g, u.x), -1.0, 1.0);
    vec3 local = vec3(sqrt((1.0 - z) * (1.0 + z)) * sampleCircle(u.y), z);
    return normalize(worldFromFrame(makeFrame(direction), local));
}

#endif
