#include "host/render/film_pictures.hpp"

#include "host/render/settings.hpp"

#include <map>

namespace glim {

Aov aovOf(const Film& film)
{
    const std::map<std::string, Aov> aovs = {
        {"normal", Aov::Normal}, {"depth", Aov::Depth}, {"albedo", Aov::Albedo}, {"bvh-steps", Aov::BvhSteps}};
    const auto found = aovs.find(findSetting(film.identity.settings, "view"));
    return found == aovs.end() ? Aov::Radiance : found->second;
}

void writeFilmPng(const std::filesystem::path& path, const Film& film, Aov aov, double exposure)
{
    const DisplayRange range = computeRange(film, aov);
    std::vector<Rgb8> colors;
    for (const PixelMoments& pixel : shownPixels(film)) {
        colors.push_back(displayColor(pixel, aov, range, exposure));
    }
    writePng(path, film.width, film.height, colors);
}

}  // namespace glim
