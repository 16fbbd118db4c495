#include "host/cli/suspect_report.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <iostream>

namespace glim {
namespace {

std::string replayOf(const Suspect& suspect, std::uint32_t width)
{
    return std::to_string(suspect.pixel % width) + "," + std::to_string(suspect.pixel / width) + "," +
           std::to_string(suspect.sampleIndex);
}

}  // namespace

void printSuspects(const RenderReport& report)
{
    if (report.options.settings.suspects == 0) {
        return;
    }
    std::cout << "Brightest samples, at most one of a pixel: " << report.suspects.size() << "\n";
    for (const Suspect& suspect : report.suspects) {
        const glm::dvec3 radiance(suspect.radiance);
        char text[200];
        std::snprintf(text, sizeof text,
                      "  luminance %-9.4g (%.4g, %.4g, %.4g), %.3g %% of its pixel, %.3g %% of the picture: --replay ",
                      suspect.luminance, radiance.r, radiance.g, radiance.b, 100.0 * suspect.shareOfPixel,
                      100.0 * suspect.shareOfPicture);
        std::cout << text << replayOf(suspect, report.film.width) << "\n";
    }
}

nlohmann::ordered_json suspectsOf(const RenderReport& report)
{
    if (report.options.settings.suspects == 0) {
        return nullptr;
    }
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Suspect& suspect : report.suspects) {
        list.push_back({{"x", suspect.pixel % report.film.width},
                        {"y", suspect.pixel / report.film.width},
                        {"sample", suspect.sampleIndex},
                        {"radiance", {suspect.radiance.r, suspect.radiance.g, suspect.radiance.b}},
                        {"luminance", suspect.luminance},
                        {"shareOfPixel", suspect.shareOfPixel},
                        {"shareOfPicture", suspect.shareOfPicture},
                        {"replay", replayOf(suspect, report.film.width)}});
    }
    return list;
}

}  // namespace glim
