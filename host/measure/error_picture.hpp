// The errors of a picture to look at: blue where it is too dark, white where it is right, red where it is too bright.
#pragma once

#include "host/image/png.hpp"
#include "host/measure/picture.hpp"

#include <vector>

namespace glim {

struct ErrorPicture {
    std::vector<Rgb8> pixels;  // kMagenta: not finite in either
    double scale = 0.0;        // the error of full colour; beyond it colours stay full
};

// The error that 95 % of the pixels stay below, so that few bright ones do not make all others white; the largest one if that is 0, as
// when only a corner differs. An error is the mean over the channels of (x-r) / sqrt(relative r^2 + epsilon). Pixels that are not finite do
// not count.
double chooseErrorScale(const Picture& picture, const Picture& reference, double relative, double epsilon);

// Draws (x-r) / sqrt(r^2 + eps), the mean of the channels: the terms of relMSE before they are squared. Full colour is chooseErrorScale's.
ErrorPicture drawErrors(const Picture& picture, const Picture& reference, double epsilon);

}  // namespace glim
