// A denoised picture, and how far it is from the truth, its bias included.
#pragma once

#include "host/measure/confidence.hpp"
#include "host/render/film_halves.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

namespace glim {

// Returns the denoised radiance of each pixel of a film, or nothing if it was ended. It may do anything, but must know nothing except the
// film.
using Denoiser = std::function<std::optional<std::vector<glm::vec3>>(const Film&)>;

struct DenoisedError {
    Interval mse;
    // Relative to the radiance before denoising, the mean of both halves: where few samples have found light, the denoised radiance and
    // what is known of its error are low together. It was .65 to 1.5 times the true relMSE in six scenes (tests/denoising.md), so it has no
    // interval.
    double relMse = 0.0;
    double noisyMse = 0.0, noisyRelMse = 0.0;  // of the mean of both halves, by the same samples
    double mean = 0.0;                         // radiance over pixels and channels, W/(sr m^2)

    // Not of a black picture, whose relMSE is 0/0, nor where float32 did not hold the radiance.
    bool isKnown() const { return std::isfinite(mean) && std::isfinite(mse.high) && std::isfinite(relMse); }
};

struct DenoisedPicture {
    std::vector<glm::vec3> radiance;
    std::vector<glm::vec3> error;  // root of the mean square error of the pixels around, W/(sr m^2); 0 where none was found
    DenoisedError measured;
    double noisyShare = 0.0;  // of the pixels: these stayed as they were, because denoising made their tile worse
};

// Half of the samples, of each pixel.
struct DenoisedHalf {
    std::vector<glm::vec3> noisy, denoised;  // radiance
    std::vector<std::uint32_t> samples;
    std::vector<bool> background;  // whether all samples have met nothing but one and the same background
};

// The radiance and the samples of a half that is still to be denoised.
DenoisedHalf noisyHalf(const Film& film);

// The mean of both halves, and its error. What denoising has put on a half's background is taken away. Where it makes a tile worse, that
// stays noisy.
DenoisedPicture joinHalves(const glm::uvec2& size, std::array<DenoisedHalf, 2> halves);

// `film` with the denoised radiance, to be shown and not to be kept: its moments are those of no samples.
Film showDenoised(Film film, const std::vector<glm::vec3>& radiance);

// Whether each pixel has samples in both halves.
bool hasBothHalves(const FilmHalves& halves);

// Denoises each half on its own; the picture is the mean of both results. Returns nothing if the denoiser was ended.
std::optional<DenoisedPicture> denoiseHalves(const FilmHalves& halves, const Denoiser& denoiser);

}  // namespace glim
