// Numbers as colours.
#pragma once

#include "host/image/png.hpp"

namespace glim {

// Blue at 0, through cyan, green and yellow to red at 1, linear in between and clamped beyond: the rainbow of the course's (CS 184)
// pictures of sampling rates, which go from blue through green to red, with two colours more to tell values apart. A NaN is
// kMagenta.
Rgb8 heatColor(double value);

// Blue at -1, through white at 0 to red at 1, clamped beyond: what is right is as light as paper, and half an error half as dark
// on both sides.
Rgb8 differenceColor(double value);

}  // namespace glim
