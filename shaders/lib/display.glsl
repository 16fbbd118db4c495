// Converts pixels to display colours, each channel from 0 to 1. host/render/aov.cpp does the same for files.
#ifndef GLIM_LIB_DISPLAY
#define GLIM_LIB_DISPLAY

#include "finite.glsl"
#include "shared/display_types.h"
#include "shared/pixel_moments.h"
#include "shared/tone_mapping.h"

// Shown for pixels that are not finite.
const vec3 kMagenta = vec3(1.0, 0.0, 1.0);

// The sRGB transfer function, IEC 61966-2-1, of x clipped to 0..1.
float encodeSrgb(float x)
{
    float c = clamp(x, 0.0, 1.0);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1.0 / 2.4) - 0.055;
}

vec3 encodeSrgb(vec3 c)
{
    return vec3(encodeSrgb(c.r), encodeSrgb(c.g), encodeSrgb(c.b));
}

// Blue, cyan, green, yellow, red at 0, 1/4, 1/2, 3/4, 1.
vec3 heatColor(float value)
{
    float place = 4.0 * clamp(value, 0.0, 1.0);
    return clamp(vec3(place - 2.0, place < 2.0 ? place : 4.0 - place, 2.0 - place), 0.0, 1.0);
}

// Rounds each channel as an 8-bit image stores it, whatever the device's own rounding.
vec3 roundToBytes(vec3 c)
{
    return floor(255.0 * c + 0.5) / 255.0;
}

vec3 depthColor(PixelMoments pixel, float nearest, float farthest)
{
    float share = clamp((pixel.depth - nearest) / max(1e-30, farthest - nearest), 0.0, 1.0);
    return pixel.alpha > 0.0 ? vec3(mix(1.0, kFarthestGrey, share)) : vec3(0.0);
}

vec3 normalColor(PixelMoments pixel)
{
    return pixel.alpha > 0.0 ? clamp(0.5 + 0.5 * pixel.normal / pixel.alpha, 0.0, 1.0) : vec3(0.0);
}

// `pixel` has at least one sample.
vec3 displayColor(PixelMoments pixel, uint aov, DisplayPass pass)
{
    if (!isFinite(pixel.mean)) {
        return kMagenta;
    }
    switch (aov) {
    case kAovNormal: return roundToBytes(normalColor(pixel));
    case kAovDepth: return roundToBytes(depthColor(pixel, pass.low, pass.high));
    case kAovAlbedo: return roundToBytes(encodeSrgb(pass.scale * pixel.albedo));
    case kAovSampleCount: return roundToBytes(heatColor((float(pixel.count) - pass.low) / max(1.0, pass.high - pass.low)));
    case kAovBvhSteps: return roundToBytes(heatColor((pixel.mean.r - pass.low) / max(1e-30, pass.high - pass.low)));
    default: return roundToBytes(encodeSrgb(mapTone(pass.scale * pixel.mean, pass.tone)));
    }
}

#endif
