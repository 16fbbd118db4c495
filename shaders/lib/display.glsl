// Converts pixels to display colours, each channel from 0 to 1, as host/render/aov.cpp does for files.
#ifndef GLIM_LIB_DISPLAY
#define GLIM_LIB_DISPLAY

#include "finite.glsl"
#include "shared/display_colors.h"
#include "shared/display_types.h"
#include "shared/luminance.h"
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

// The same of the surfaces in the pixel alone, with their coverage as alpha.
vec4 displaySurfaces(PixelMoments pixel, uint aov, DisplayPass pass)
{
    if (!isFinite(pixel.mean)) {
        return vec4(kMagenta, 1.0);
    }
    if (!(pixel.alpha > 0.0)) {
        return vec4(0.0);
    }
    pixel.mean /= pixel.alpha;
    pixel.albedo /= pixel.alpha;
    return vec4(displayColor(pixel, aov, pass), pixel.alpha);
}

// As the pass draws them, with alpha.
vec4 drawnColor(PixelMoments pixel, uint aov, DisplayPass pass)
{
    if (pass.drawn == kDrawnOverCheckers) {
        return displaySurfaces(pixel, aov, pass);
    }
    vec3 color = displayColor(pixel, aov, pass);
    return vec4(pass.drawn == kDrawnInGrey ? roundToBytes(vec3(255.0 * computeLuminance(color))) : color, 1.0);
}

// What shows of a colour with alpha in the window, at this place.
vec3 overCheckers(vec4 color, uvec2 at)
{
    return color.a < 1.0 ? roundToBytes(overCheckers(255.0 * color.rgb, color.a, at.x, at.y)) : color.rgb;
}

// `value` is the film's, `reference` that of the other film or alpha, which only differences and surfaces need; `at` is in the window.
vec3 viewColor(vec3 value, vec3 reference, uvec2 at, ViewPass pass)
{
    bool differs = pass.shownAs == kShownAsDifference;
    if (!isFinite(value) || (differs && !isFinite(reference))) {
        return kMagenta;
    }
    if (pass.shownAs == kShownAsSurfaces) {
        float alpha = reference.x;
        vec3 light = alpha > 0.0 ? value / alpha : vec3(0.0);
        return overCheckers(vec4(roundToBytes(lightColor(mapTone(pass.scale * light, pass.tone))), alpha), at);
    }
    switch (pass.shownAs) {
    case kShownAsError: return roundToBytes(errorColor(value.x, pass.high));
    case kShownAsVector: return value == vec3(0.0) ? vec3(0.0) : roundToBytes(vectorColor(value));
    case kShownAsDepth: return value.x == 0.0 ? vec3(0.0) : roundToBytes(depthColor(value.x, pass.low, pass.high));
    case kShownAsHeat: return roundToBytes(heatColor(placeOnScale(dot(value, vec3(1.0 / 3.0)), pass.low, pass.high, kSmallestScale)));
    case kShownAsDifference:
        return roundToBytes(differenceColor(pass.scale * signedDifference(value, reference, pass.relative, pass.epsilon)));
    default: return roundToBytes(lightColor(mapTone(pass.scale * value, pass.tone)));
    }
}

#endif
