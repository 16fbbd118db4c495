// Numbers and vectors as colours of a display, each channel from 0 to 255 and not yet rounded to a byte. Files (host/render/aov.cpp and
// host/measure/error_picture.cpp) and windows (lib/display.glsl) share these functions.
#ifndef GLIM_SHARED_DISPLAY_COLORS_H
#define GLIM_SHARED_DISPLAY_COLORS_H
#include "vocabulary.h"

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
