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

// Draws (x-r) / sqrt(r^2 + eps), the mean of the channels: the terms of relMSE before they are squared. Full colour is the
// error that 95 % of the pixels stay below, so that few bright ones do not make all others white.
ErrorPicture drawErrors(const Picture& picture, const Picture& reference, double epsilon);

}  // namespace glim
