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

// Blue, white, red at -1, 0, 1.
vec3 differenceColor(float value)
{
    vec3 end = value < 0.0 ? vec3(0.0, 40.0, 200.0) / 255.0 : vec3(200.0, 0.0, 0.0) / 255.0;
    return mix(vec3(1.0), end, min(abs(value), 1.0));
}

// Rounds each channel as an 8-bit image stores it, whatever the device's own rounding.
vec3 roundToBytes(vec3 c)
{
    return floor(255.0 * c + 0.5) / 255.0;
}

// The place of a value on a scale from 0 to 1. On a scale without length it is 0: 1e-30 is below the distance of any two values that are
// told apart.
float placeOf(float value, float low, float high)
{
    return clamp((value - low) / max(1e-30, high - low), 0.0, 1.0);
}

vec3 depthColor(float depth, float nearest, float farthest)
{
    return vec3(mix(1.0, kFarthestGrey, placeOf(depth, nearest, farthest)));
}

vec3 vectorColor(vec3 v)
{
    return clamp(0.5 + 0.5 * v, 0.0, 1.0);
}

// `pixel` has at least one sample.
vec3 displayColor(PixelMoments pixel, uint aov, DisplayPass pass)
{
    if (!isFinite(pixel.mean)) {
        return kMagenta;
    }
    switch (aov) {
    case kAovNormal: return pixel.alpha > 0.0 ? roundToBytes(vectorColor(pixel.normal / pixel.alpha)) : vec3(0.0);
    case kAovDepth: return pixel.alpha > 0.0 ? roundToBytes(depthColor(pixel.depth, pass.low, pass.high)) : vec3(0.0);
    case kAovAlbedo: return roundToBytes(encodeSrgb(pass.scale * pixel.albedo));
    case kAovSampleCount: return roundToBytes(heatColor((float(pixel.count) - pass.low) / max(1.0, pass.high - pass.low)));
    case kAovBvhSteps: return roundToBytes(heatColor(placeOf(pixel.mean.r, pass.low, pass.high)));
    default: return roundToBytes(encodeSrgb(mapTone(pass.scale * pixel.mean, pass.tone)));
    }
}

// The terms of relMSE before they are squared, or plain differences; the mean of the channels.
float signedDifference(vec3 x, vec3 r, float relative, float epsilon)
{
    vec3 difference = x - r;
    vec3 terms = difference / sqrt(relative * r * r + epsilon);
    return dot(mix(terms, vec3(0.0), equal(x, r)), vec3(1.0 / 3.0));  // 0 where x is r, even if 0 / 0
}

// `value` is the film's, `reference` that of the other film, which only differences need.
vec3 viewColor(vec3 value, vec3 reference, ViewPass pass)
{
    bool differs = pass.shownAs == kShownAsDifference;
    if (!isFinite(value) || (differs && !isFinite(reference))) {
        return kMagenta;
    }
    switch (pass.shownAs) {
    case kShownAsVector: return value == vec3(0.0) ? vec3(0.0) : roundToBytes(vectorColor(value));
    case kShownAsDepth: return value.x == 0.0 ? vec3(0.0) : roundToBytes(depthColor(value.x, pass.low, pass.high));
    case kShownAsHeat: return roundToBytes(heatColor(placeOf(dot(value, vec3(1.0 / 3.0)), pass.low, pass.high)));
    case kShownAsDifference:
        return roundToBytes(differenceColor(pass.scale * signedDifference(value, reference, pass.relative, pass.epsilon)));
    default: return roundToBytes(encodeSrgb(mapTone(pass.scale * value, pass.tone)));
    }
}

#endif
