// An upper bound of a picture's error, for pixels that have too few samples to know their own.
#pragma once

#include "host/measure/picture.hpp"

#include <optional>

namespace glim {

// At most this is the mean squared error of the picture, mean of the channels, in 95 of 100 pictures: noise makes neighbouring pixels
// differ, and so does the picture itself. Nothing if the picture has fewer than 3x3 pixels or one that is not finite.
std::optional<double> boundMse(const Picture& picture);

}  // namespace glim
