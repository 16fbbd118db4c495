#include "host/bench/bench_reference.hpp"

#include "host/error.hpp"
#include "host/image/exr.hpp"
#include "host/render/film_file.hpp"

#include <algorithm>

namespace glim {
namespace {

constexpr std::uint32_t kSeedDistance = 1U << 31;

std::string sizeText(std::uint32_t width, std::uint32_t height) { return std::to_string(width) + "x" + std::to_string(height); }

}  // namespace

RenderSettings referenceSettings(const RenderSettings& settings, std::uint32_t samples)
{
    RenderSettings reference;
    reference.width = settings.width;
    reference.height = settings.height;
    reference.sampleEnd = samples * kReferenceFactor;
    reference.bounces = settings.bounces;
    reference.paths = settings.paths;
    reference.seed = settings.seed + kSeedDistance;
    return reference;
}

bool isReference(const std::filesystem::path& file, const std::string& scene, const RenderSettings& settings)
{
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
        return false;
    }
    try {
        const Film film = readFilmHeader(file);
        return film.complete && film.width == settings.width && film.height == settings.height && film.identity.scene == scene &&
               film.identity.settings == describeSettings(settings) && film.sampleRanges.size() == 1 && film.sampleRanges[0].first == 0 &&
               film.sampleRanges[0].second >= settings.sampleEnd;
    } catch (const InputError&) {
        return false;  // no film: it is made anew
    }
}

Picture readReference(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height, const std::string& scene,
                      const std::vector<std::uint32_t>& seeds)
{
    const Image image = readExr(file);
    if (image.width != width || image.height != height) {
        throw InputError(MessageId::Mismatch, {part::file(file), ": is a picture of ", part::value(sizeText(image.width, image.height)),
                                               ", expected ", part::expected(sizeText(width, height)), " as of the bench."});
    }
    if (image.attributes.count("glim:film") > 0) {
        const Film film = readFilmHeader(file, image);
        if (film.identity.scene != scene) {
            throw InputError(MessageId::Mismatch,
                             {part::file(file), ": is a picture of another ", part::place("scene or camera"), " (",
                              part::value(film.sceneFile), "), expected ", part::expected("one of the scene of the bench"), "."});
        }
        if (std::find(seeds.begin(), seeds.end(), film.identity.seed) != seeds.end()) {
            throw InputError(
                MessageId::Conflict,
                {part::file(file), ": was made from ", part::place("seed"), " ", part::value(std::to_string(film.identity.seed)),
                 ", which is one of the bench's, expected another: the errors would not be independent."});
        }
    }
    return makePicture(image, file.string());
}

}  // namespace glim
