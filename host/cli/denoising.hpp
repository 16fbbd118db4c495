// --denoise: the denoised picture of a render, and what is said of it.
#pragma once

#include "host/denoise/denoised_picture.hpp"
#include "host/json.hpp"

#include <string>

namespace glim {

struct Denoising {
    DenoisedPicture picture;
    std::string denoiser;
    double seconds;
};

// `film` with the denoised radiance, to be shown and not to be kept: its moments are those of no samples.
Film showDenoised(Film film, const Denoising& denoising);

// Reads like ", denoised: relMSE .001 [.0009, .0011], 4.2 times less than noisy, RMSE 1 % [...] of the mean".
std::string denoisingText(const Denoising& denoising);
Json denoisingJson(const Denoising& denoising);

}  // namespace glim
