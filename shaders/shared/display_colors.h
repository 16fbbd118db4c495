// Numbers and vectors as colours of a display, each channel from 0 to 255 and not yet rounded to a byte. Files (host/render/aov.cpp and
// host/measure/error_picture.cpp) and windows (lib/display.glsl) share these functions.
#ifndef GLIM_SHARED_DISPLAY_COLORS_H
#define GLIM_SHARED_DISPLAY_COLORS_H
#include "vocabulary.h"

#ifdef __cplusplus
#include <cmath>
#endif

GLIM_SHARED_BEGIN

// The grey of the farthest depth: brighter than the black where no surface is.
GLIM_CONST Real kFarthestGrey = 0.125;

// Of two values that are told apart, the distance on a scale is larger.
GLIM_CONST Real kSmallestScale = 1e-30;

// The place of a value on a scale from 0, at low, to 1. A scale is at least `smallest` long.
GLIM_FUNCTION Real placeOnScale(Real value, Real low, Real high, Real smallest) { return (value - low) / max(smallest, high - low); }

// Blue, cyan, green, yellow, red at 0, 1/4, 1/2, 3/4, 1; linear in between and clamped outside. The course's (CS 184) pictures of sampling
// rates go from blue through green to red; the two colours in between tell more values apart.
GLIM_FUNCTION RealVec3 heatColor(Real value)
{
    Real place = 4.0 * clamp(value, 0.0, 1.0);
    return 255.0 * clamp(RealVec3(place - 2.0, place < 2.0 ? place : 4.0 - place, 2.0 - place), 0.0, 1.0);
}

// Blue, white, red at -1, 0, 1; linear in between and clamped outside.
GLIM_FUNCTION RealVec3 differenceColor(Real value)
{
    RealVec3 end = value < 0.0 ? RealVec3(0.0, 40.0, 200.0) : RealVec3(200.0, 0.0, 0.0);
    return 255.0 + min(abs(value), 1.0) * (end - 255.0);
}

// An error that nothing is known of. Its grey is in none of the colours of errors.
GLIM_CONST Real kUnknownError = -1.0;
GLIM_CONST Real kUnknownGrey = 128.0;

// The colours of errors differ from a hundredth of the target to a hundred times as much.
GLIM_CONST Real kErrorSpan = 100.0;

// From blue to cyan up to the target, and from yellow to red beyond it, by the error's logarithm.
GLIM_FUNCTION RealVec3 errorColor(Real error, Real target)
{
    if (error < 0.0) {
        return RealVec3(kUnknownGrey);
    }
    Real place = log(max(error / target, 1.0 / kErrorSpan)) / log(kErrorSpan);
    return heatColor(error <= target ? 0.25 + 0.25 * min(place, 0.0) : 0.75 + 0.25 * max(place, 0.0));
}

// The checkerboard behind what is transparent, as image programs have it: the side of its squares in pixels of the window, and their greys.
GLIM_CONST uint kCheckerSide = 12u;
GLIM_CONST float kLightChecker = 153.0F;
GLIM_CONST float kDarkChecker = 102.0F;

// A colour of so much coverage over it, in column x and row y of the window. Displays' numbers are mixed, not light.
GLIM_FUNCTION vec3 overCheckers(vec3 color, float alpha, uint x, uint y)
{
    float grey = (x / kCheckerSide + y / kCheckerSide) % 2u == 0u ? kLightChecker : kDarkChecker;
    return mix(vec3(grey), color, clamp(alpha, 0.0F, 1.0F));
}

// From white, of the nearest depth, to kFarthestGrey.
GLIM_FUNCTION vec3 depthColor(float depth, float nearest, float farthest)
{
    Real place = clamp(placeOnScale(Real(depth), Real(nearest), Real(farthest), kSmallestScale), 0.0, 1.0);
    return vec3(255.0F * float(1.0 - (1.0 - kFarthestGrey) * place));
}

GLIM_FUNCTION vec3 vectorColor(vec3 v) { return 255.0F * clamp(0.5F + 0.5F * v, 0.0F, 1.0F); }

// A term of relMSE before it is squared, or a plain difference: 0 where x is r, even if it were 0 / 0.
GLIM_FUNCTION Real signedDifference(Real x, Real r, Real relative, Real epsilon)
{
    return x == r ? 0.0 : (x - r) / sqrt(relative * r * r + epsilon);
}

// Their mean.
GLIM_FUNCTION Real signedDifference(RealVec3 x, RealVec3 r, Real relative, Real epsilon)
{
    return (signedDifference(x.x, r.x, relative, epsilon) + signedDifference(x.y, r.y, relative, epsilon) +
            signedDifference(x.z, r.z, relative, epsilon)) /
           3.0;
}

GLIM_SHARED_END
#endif
