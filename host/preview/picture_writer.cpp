#include "host/preview/picture_writer.hpp"

#include "host/denoise/nl_means.hpp"
#include "host/error.hpp"
#include "host/render/film_file.hpp"
#include "host/render/film_pictures.hpp"

#include <chrono>
#include <cstdio>
#include <utility>

namespace glim {
namespace {

std::string freeStem(const std::filesystem::path& scene)
{
    for (int number = 1;; ++number) {
        char digits[16];
        std::snprintf(digits, sizeof digits, "-%03d", number);
        const std::string stem = scene.stem().string() + digits;
        if (!std::filesystem::exists(stem + ".exr") && !std::filesystem::exists(stem + ".png")) {
            return stem;
        }
    }
}

std::string writeBoth(const std::string& stem, const Film& film, Aov aov, const Look& look, const std::optional<DenoisedPicture>& denoised)
{
    try {
        if (denoised) {
            const DenoisedLayers layers{denoised->radiance, denoised->error, NlMeans::kName};
            writeFilm(stem + ".exr", film, {.denoised = &layers});
            writeFilmPicture(stem + ".png", showDenoised(film, denoised->radiance), aov, look);
        } else {
            writeFilm(stem + ".exr", film);
            writeFilmPicture(stem + ".png", film, aov, look);
        }
    } catch (const InputError& error) {
        return error.what();
    }
    return "wrote " + stem + ".exr and .png";
}

}  // namespace

void PictureWriter::write(const std::filesystem::path& scene, Film film, Aov aov, const Look& look, std::optional<DenoisedPicture> denoised)
{
    if (writing_.valid()) {
        writing_.wait();
    }
    writing_ = std::async(std::launch::async, writeBoth, freeStem(scene), std::move(film), aov, look, std::move(denoised));
}

std::optional<std::string> PictureWriter::takeReport(bool wait)
{
    if (!writing_.valid() || (!wait && writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)) {
        return std::nullopt;
    }
    return writing_.get();
}

}  // namespace glim
