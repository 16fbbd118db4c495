// The parameters of the kernel that draws the window's picture.
#ifndef GLIM_SHARED_DISPLAY_TYPES_H
#define GLIM_SHARED_DISPLAY_TYPES_H
#include "bindings.h"
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// The grey of the farthest depth: brighter than the black where no surface is.
GLIM_CONST float kFarthestGrey = 0.125;

// Push constants: a tile of the film, stretched over the window's picture.
struct DisplayPass {
    uint width, height;  // of the picture
    uint filmWidth, filmHeight;
    uint tileBegin, tileCount;  // pixels of the film
    float scale;                // 2^EV, of radiance and albedo
    uint tone;                  // kToneNone ..., of radiance
    float low, high;            // ends of the scale of depths, samples or steps
};

GLIM_SHARED_END
#endif
