// A film with shadow catchers as a transparent picture.
#pragma once

#include "host/render/film.hpp"

namespace glim {

// As shownPixels(), but composited if the film has shadow catchers (shaders/shared/composite.h).
std::vector<PixelMoments> pictureOf(const Film& film);

// The standard error of a pixel's alpha as far as catchers make it: by first-order propagation from the spread of block means of Y(L_1) and
// Y(L_0), with their covariance. NaN if fewer than two blocks are known.
double computeAlphaError(const PixelMoments& pixel, const CatcherMoments& catcher);

// The root mean square of that over all pixels with a catcher; nothing if none has one or if one's error is not known.
std::optional<double> computeAlphaRmse(const Film& film);

}  // namespace glim
