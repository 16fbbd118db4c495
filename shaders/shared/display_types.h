// What the kernels that draw the window's picture are told.
#ifndef GLIM_SHARED_DISPLAY_TYPES_H
#define GLIM_SHARED_DISPLAY_TYPES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// Looks at a film.
GLIM_CONST uint kLookRadiance = 0u;
GLIM_CONST uint kLookNormal = 1u;
GLIM_CONST uint kLookDepth = 2u;
GLIM_CONST uint kLookAlbedo = 3u;
GLIM_CONST uint kLookRate = 4u;   // samples of a pixel
GLIM_CONST uint kLookSteps = 5u;  // of a film of --view bvh-steps

// Of the farthest depth: above the black of what is not there.
GLIM_CONST float kFarthestGrey = 0.125;

// Push constants: a slab of the film, stretched over the window's picture.
struct DisplayPass {
    uint width, height;          // of the picture
    uint filmWidth, filmHeight;
    uint slabBegin, slabCount;   // pixels of the film
    float scale;                 // 2^EV, of radiance and albedo
    float low, high;             // ends of the scale of depths, samples or steps
    uint textWidth, textHeight;  // of the text in the upper left corner
};

GLIM_SHARED_END
#endif
