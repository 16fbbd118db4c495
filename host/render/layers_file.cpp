#include "host/render/layers_file.hpp"

#include "host/image/exr.hpp"
#include "host/message.hpp"
#include "host/render/composite.hpp"
#include "host/render/film_place.hpp"
#include "version.h"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

constexpr float kLargestHalf = 65504.0F;

}  // namespace

void writeLayers(const std::filesystem::path& path, const Film& film, ExrCompression compression)
{
    Image image;
    image.compression = compression;
    image.attributes = {{"software", "glim " GLIM_VERSION}, {"glim:settings", film.identity.settings}};
    describePlace(image, film);
    std::size_t tooBright = 0;
    const auto add = [&](const std::string& name, float value) {
        const bool isTooLarge = std::isfinite(value) && std::abs(value) > kLargestHalf;
        tooBright += isTooLarge;
        image.halves.insert(name);
        image.channels[name].push_back(isTooLarge ? std::copysign(kLargestHalf, value) : value);
    };
    const std::vector<std::string> groups = getLightGroups(film);
    const std::vector<PixelMoments> picture = pictureOf(film);
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const PixelMoments& pixel = picture[i];
        for (int k = 0; k < 3; ++k) {
            add(std::string(1, "RGB"[k]), pixel.mean[k]);
            add(std::string("albedo.") + "RGB"[k], pixel.albedo[k]);
            add(std::string("normal.") + "XYZ"[k], pixel.normal[k]);
        }
        add("A", pixel.alpha);
        image.channels["depth.Z"].push_back(pixel.depth);
        for (std::size_t g = 0; g < groups.size(); ++g) {
            for (int k = 0; k < 3; ++k) {
                add("lights." + groups[g] + '.' + "RGB"[k], shownOfGroup(film, i, g)[k]);
            }
        }
    }
    writeExr(path, image);
    if (tooBright > 0) {
        warn(MessageId::HalfOverflow, {part::file(path), ": ", part::value(std::to_string(tooBright)),
                                       " values are beyond what half floats hold and were stored as 65504; the film has them."});
    }
}

}  // namespace glim
