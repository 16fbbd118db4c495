// A pixel with shadow catchers as a transparent one. Files and the window share these functions.
#ifndef GLIM_SHARED_COMPOSITE_H
#define GLIM_SHARED_COMPOSITE_H
#include "luminance.h"
#include "pixel_moments.h"
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// Y(L_1) / Y(L_0).
GLIM_FUNCTION Real computeClearness(CatcherMoments catcher)
{
    Real without = computeLuminance(RealVec3(catcher.without));
    return without > 0.0 ? computeLuminance(RealVec3(catcher.with)) / without : 1.0;
}

// With L_1 the light of samples that met a catcher first, L_0 what it would be without the objects, and Y the luminance: the catcher covers
// a background by 1 - Y(L_1) / Y(L_0), from 0 to 1. The pixel's mean becomes premultiplied, and its alpha the share of the background that
// objects and shadows cover: laid over L_0 it is the film. Where a pixel shows an edge, this takes L_0 for even within the pixel, as every
// picture with alpha takes its background.
GLIM_FUNCTION PixelMoments compositePixel(PixelMoments shown, CatcherMoments catcher)
{
    Real clear = clamp(computeClearness(catcher), 0.0, 1.0);
    PixelMoments pixel = shown;
    pixel.mean = vec3(RealVec3(shown.mean) - clear * RealVec3(catcher.without));
    pixel.alpha = float(Real(shown.alpha) - clear * Real(catcher.share));
    return pixel;
}

GLIM_SHARED_END
#endif
