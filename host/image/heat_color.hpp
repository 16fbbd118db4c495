// Numbers shown as colours.
#pragma once

#include "host/image/png.hpp"

namespace glim {

// Blue at 0, then cyan, green, yellow, and red at 1; linear in between and clamped outside. The course's (CS 184) pictures of sampling
// rates go from blue through green to red; the two colours in between tell more values apart. NaN gives kMagenta.
Rgb8 heatColor(double value);

// Blue at -1, white at 0, red at 1; linear in between and clamped outside.
Rgb8 differenceColor(double value);

}  // namespace glim
