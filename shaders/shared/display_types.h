// The parameters of the kernel that draws the window's picture.
#ifndef GLIM_SHARED_DISPLAY_TYPES_H
#define GLIM_SHARED_DISPLAY_TYPES_H
#include "bindings.h"
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// How the kernels preview and preview_means draw the film.
GLIM_CONST uint kDrawnInColor = 0u;
GLIM_CONST uint kDrawnInGrey = 1u;
GLIM_CONST uint kDrawnOverCheckers = 2u;  // the surfaces alone, over a checkerboard

// Push constants: a tile of the film, stretched over a rectangle of the window's picture.
struct DisplayPass {
    uint left, top, width, height;  // of the rectangle
    uint filmWidth, filmHeight;
    uint tileBegin, tileCount;  // pixels of the film
    float scale;                // 2^EV, of radiance and albedo
    uint tone;                  // kToneNone ..., of radiance
    float low, high;            // ends of the scale of depths, samples or steps
    uint drawn;                 // kDrawnInColor ...
};

// How the kernel view shows three numbers of a pixel.
GLIM_CONST uint kShownAsColor = 0u;       // light
GLIM_CONST uint kShownAsVector = 1u;      // with components from -1 to 1; black where all are 0
GLIM_CONST uint kShownAsDepth = 2u;       // black where it is 0
GLIM_CONST uint kShownAsHeat = 3u;        // the mean of the three
GLIM_CONST uint kShownAsDifference = 4u;  // from the same pixel of the reference
GLIM_CONST uint kShownAsSurfaces = 5u;    // light whose alpha is the first number of the reference, over a checkerboard
GLIM_CONST uint kShownAsError = 6u;       // the first number against the target, which is `high`

// Push constants: a band of rows of the window's picture, and the rectangle of the picture that shows a film.
struct ViewPass {
    uint width, firstRow, rows;     // of the band
    uint left, top, right, bottom;  // of the rectangle; right and bottom are the first column and row beyond it
    uint shownAs;                   // kShownAsColor ...
    float scale;                    // 2^EV, of colours; differences are multiplied by it
    uint tone;                      // kToneNone ..., of colours
    float low, high;                // ends of the scale of depths or heat; high is also the target of errors
    float relative, epsilon;        // a difference is divided by sqrt(relative r^2 + epsilon), with the reference r
};

GLIM_SHARED_END
#endif
