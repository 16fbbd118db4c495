#include "host/render/film_pictures.hpp"

#include "host/render/settings.hpp"

#include <map>

namespace glim {

Look lookOf(const Film& film)
{
    const std::map<std::string, Look> looks = {
        {"normal", Look::Normal}, {"depth", Look::Depth}, {"albedo", Look::Albedo}, {"bvh-steps", Look::Steps}};
    const auto found = looks.find(findSetting(film.identity.settings, "view"));
    return found == looks.end() ? Look::Radiance : found->second;
}

void writeFilmPng(const std::filesystem::path& path, const Film& film, Look look, double exposure)
{
    const LookRange range = computeRange(film, look);
    std::vector<Rgb8> colors;
    for (const PixelMoments& pixel : film.pixels) {
        colors.push_back(lookAt(pixel, look, range, exposure));
    }
    writePng(path, film.width, film.height, colors);
}

}  // namespace glim
