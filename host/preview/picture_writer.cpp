#include "host/preview/picture_writer.hpp"

#include "host/denoise/nl_means.hpp"
#include "host/error.hpp"
#include "host/render/film_file.hpp"
#include "host/render/film_pictures.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace glim {
namespace {

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
    writing_ =
        std::async(std::launch::async, writeBoth, freeStem(scene, {".exr", ".png"}), std::move(film), aov, look, std::move(denoised));
}

std::string freeStem(const std::filesystem::path& scene, std::initializer_list<const char*> endings)
{
    for (int number = 1;; ++number) {
        const std::string stem = scene.stem().string() + format("-%03d", number);
        if (std::ranges::none_of(endings, [&stem](const char* ending) { return std::filesystem::exists(stem + ending); })) {
            return stem;
        }
    }
}

std::optional<std::string> PictureWriter::takeReport(bool wait)
{
    if (!writing_.valid() || (!wait && writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)) {
        return std::nullopt;
    }
    return writing_.get();
}

}  // namespace glim
