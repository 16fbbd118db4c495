// A film with shadow catchers as a transparent picture.
#pragma once

#include "host/render/film.hpp"

namespace glim {

// With L_1 the light of samples that met a catcher first, L_0 what it would be without the objects, and Y the luminance: the catcher covers
// a background by 1 - Y(L_1) / Y(L_0), from 0 to 1. The pixel's mean becomes premultiplied, and its alpha the share of the background that
// objects and shadows cover: laid over L_0 it is the film. Where a pixel shows an edge, this takes L_0 for even within the pixel, as every
// picture with alpha takes its background.
PixelMoments compositePixel(const PixelMoments& shown, const CatcherMoments& catcher);

// As shownPixels(), but composited if the film has shadow catchers.
std::vector<PixelMoments> pictureOf(const Film& film);

// The standard error of a pixel's alpha as far as catchers make it: by first-order propagation from the spread of block means of Y(L_1) and
// Y(L_0), with their covariance. NaN if fewer than two blocks are known.
double computeAlphaError(const PixelMoments& pixel, const CatcherMoments& catcher);

// The root mean square of that over all pixels with a catcher; nothing if none has one or if one's error is not known.
std::optional<double> computeAlphaRmse(const Film& film);

}  // namespace glim
