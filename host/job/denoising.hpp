// --denoise: makes the denoised picture of a render, and reports its error.
#pragma once

#include "host/denoise/denoised_picture.hpp"
#include "host/denoise/nl_means.hpp"
#include "host/denoise/oidn.hpp"
#include "host/job/render_job.hpp"
#include "host/json.hpp"
#include "host/render/film_file.hpp"
#include "host/render/renderer.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace glim {

struct Denoising {
    DenoisedPicture picture;
    std::string denoiser;
    double seconds;
};

// Denoises what a renderer has rendered, with the denoiser that the options name. Kept for the pictures of a session.
class FilmDenoiser {
public:
    // Nothing if `shouldContinue` ended it, if samples are missing, or if the renderer keeps no halves.
    std::optional<Denoising> denoise(const RenderJob& options, Renderer& renderer, const std::function<bool()>& shouldContinue);
    // Throws InputError if the options name a library that cannot be loaded.
    void open(const RenderJob& options);

private:
    std::optional<NlMeans> nlMeans_;
    std::optional<Oidn> oidn_;
    std::filesystem::path oidnPath_;
};

// The layers of its film. They view the picture.
inline DenoisedLayers layersOf(const Denoising& denoising)
{
    return {denoising.picture.radiance, denoising.picture.error, denoising.denoiser};
}

// By what factor the error is above the target; at most 1: it is reached.
double timesToTarget(const DenoisedError& error, const ErrorTarget& target);

// Reads like ", denoised: measured RMSE 1 % [.9, 1.1] of the mean (noisy 4 %), relMSE about .001 (noisy .01)".
std::string denoisingText(const Denoising& denoising);
Json denoisingJson(const Denoising& denoising);

}  // namespace glim
