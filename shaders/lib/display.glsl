// Converts pixels to display colours, each channel from 0 to 1, as host/render/aov.cpp does for files.
#ifndef GLIM_LIB_DISPLAY
#define GLIM_LIB_DISPLAY

#include "finite.glsl"
#include "shared/display_colors.h"
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

// Rounds each channel, from 0 to 255, as an 8-bit image stores it, whatever the device's own rounding.
vec3 roundToBytes(vec3 c)
{
    return floor(c + 0.5) / 255.0;
}

vec3 lightColor(vec3 light)
{
    return 255.0 * encodeSrgb(light);
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
    case kAovAlbedo: return roundToBytes(lightColor(pass.scale * pixel.albedo));
    case kAovSampleCount: return roundToBytes(heatColor(placeOnScale(float(pixel.count), pass.low, pass.high, 1.0)));
    case kAovBvhSteps: return roundToBytes(heatColor(placeOnScale(pixel.mean.r, pass.low, pass.high, kSmallestScale)));
    default: return roundToBytes(lightColor(mapTone(pass.scale * pixel.mean, toneOfPixel(pixel.mean, pixel.albedo, pass.tone))));
    }
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
    case kShownAsHeat: return roundToBytes(heatColor(placeOnScale(dot(value, vec3(1.0 / 3.0)), pass.low, pass.high, kSmallestScale)));
    case kShownAsDifference:
        return roundToBytes(differenceColor(pass.scale * signedDifference(value, reference, pass.relative, pass.epsilon)));
    default: return roundToBytes(lightColor(mapTone(pass.scale * value, pass.tone)));
    }
}

#endif
