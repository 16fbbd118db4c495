// The film as a window shows it. The push constants are not those of a pass that traces.
#ifndef GLIM_ACCESS_DISPLAY
#define GLIM_ACCESS_DISPLAY

#include "features.glsl"
#include "lib/moments.glsl"
#include "shared/composite.h"
#include "shared/display_types.h"

layout(push_constant, scalar) uniform DisplayBlock { DisplayPass pass; };
layout(local_size_x_id = kSpecWorkgroup) in;

#define DECLARE(number, type, name) \
    layout(set = 0, binding = number, scalar) readonly buffer name##Buffer { type name[]; }

DECLARE(kBindBlocks, BlockSums, filmBlocks);
DECLARE(kBindPages, PixelMoments, filmPages);
DECLARE(kBindCatchers, CatcherSums, filmCatchers);
DECLARE(kBindFolded, PixelMoments, filmFolded);  // of the pages that the host has taken
DECLARE(kBindFoldedCatchers, CatcherMoments, filmFoldedCatchers);
layout(set = 0, binding = kBindPicture, rgba8) writeonly uniform image2D picture;

// All samples so far, as the host folds them.
PixelMoments computePixelMoments(uint pixel)
{
    PixelMoments page = foldMoments(filmPages[pixel], computeBlockMoments(filmBlocks[pixel]));
    return kFolded ? foldMoments(filmFolded[pixel], page) : page;
}

CatcherMoments computeCatcherMoments(uint pixel)
{
    CatcherMoments page = foldCatcher(filmCatchers[pixel], filmBlocks[pixel].count).page;
    return kFolded ? foldMoments(filmFoldedCatchers[pixel], page) : page;
}

// As a picture has it: with kFeatureCatcher premultiplied, with the alpha of objects and their shadows.
PixelMoments computeShownMoments(uint pixel)
{
    PixelMoments moments = computePixelMoments(pixel);
    if (hasFeature(kFeatureCatcher)) {
        moments = compositePixel(moments, computeCatcherMoments(pixel));
    }
    return moments;
}

#endif
