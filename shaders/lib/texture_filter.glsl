// Texture coordinates to texels, and the values of texels, as glTF 2.0 defines them: (0, 0) is the upper left corner of the image's first
// texel.
#ifndef GLIM_LIB_TEXTURE_FILTER
#define GLIM_LIB_TEXTURE_FILTER

#include "shared/scene_types.h"

// The texel before a coordinate, the next one, and the weight of the next.
struct TexelPair {
    uint first, second;
    float weight;
};

// A coordinate that wraps, in [0, 1]. Reduced first, so that a large one keeps what digits it has. Not finite: 0.
float wrapCoordinate(float t, uint wrap)
{
    float wrapped = wrap == kRepeat ? t - floor(t) : wrap == kMirrored ? abs(t - 2.0 * floor(0.5 * t + 0.5)) : clamp(t, 0.0, 1.0);
    return wrapped >= 0.0 && wrapped <= 1.0 ? wrapped : 0.0;
}

// The neighbours beyond an edge: those of the other edge if the image repeats, else the edge itself.
TexelPair bilinearTexels(float t, uint size, uint wrap)
{
    float x = wrapCoordinate(t, wrap) * float(size) - 0.5;
    float below = floor(x);
    int first = int(below), last = int(size) - 1;
    bool repeats = wrap == kRepeat;
    uint low = first < 0 ? (repeats ? uint(last) : 0u) : uint(min(first, last));
    uint high = first >= last ? (repeats ? 0u : uint(last)) : uint(first + 1);
    return TexelPair(low, high, x - below);
}

uint nearestTexel(float t, uint size, uint wrap)
{
    return min(uint(wrapCoordinate(t, wrap) * float(size)), size - 1u);
}

// IEC 61966-2-1, from [0, 1] to linear. Above the linear piece a polynomial of degree 9, fitted here (minimax) about its middle: off by
// 3.1e-7 at most. The driver's own decoding is off by up to 1.2e-3.
vec3 linearFromSrgb(vec3 s)
{
    vec3 t = s - 0.5;
    vec3 p = vec3(0.10732142);
    p = p * t - 0.08895443;
    p = p * t + 0.01327667;
    p = p * t - 0.02012968;
    p = p * t + 0.0456282;
    p = p * t - 0.07707466;
    p = p * t + 0.28037291;
    p = p * t + 1.16744148;
    p = p * t + 0.92558443;
    p = p * t + 0.21404095;
    return mix(min(p, vec3(1.0)), s * (1.0 / 12.92), lessThanEqual(s, vec3(0.04045)));
}

#endif
