#include "host/flatten/camera_options.hpp"

#include "host/text.hpp"

#include <array>
#include <span>

namespace glim {
namespace {

std::string pointText(const glm::dvec3& v) { return exactText(v.x) + "," + exactText(v.y) + "," + exactText(v.z); }

std::string numbersText(std::span<const double> numbers)
{
    std::string text;
    for (const double number : numbers) {
        text += (text.empty() ? "" : ",") + exactText(number);
    }
    return text;
}

void addProjection(const Projection& projection, OptionTexts& words)
{
    using Model = Projection::Model;
    const std::span<const double> distortion(projection.distortion);
    if (projection.intrinsics) {
        const auto& [focal, center, size] = *projection.intrinsics;
        words.emplace_back("intrinsics", numbersText(std::array{focal.x, focal.y, center.x, center.y}));
    }
    if (projection.shift != glm::dvec2(0.0)) {
        words.emplace_back("shift", numbersText(std::array{projection.shift.x, projection.shift.y}));
    }
    if (projection.model == Model::RadialTangential || projection.model == Model::Fisheye) {
        const bool isFisheye = projection.model == Model::Fisheye;
        words.emplace_back(isFisheye ? "fisheye" : "distortion", numbersText(isFisheye ? distortion.first(4) : distortion));
    }
    if (projection.model == Model::Equirectangular) {
        words.emplace_back("projection", "equirectangular");
    }
    if (projection.crop) {
        const auto& [corner, size, whole] = *projection.crop;
        words.emplace_back("crop", numbersText(std::array<double, 4>{static_cast<double>(corner.x), static_cast<double>(corner.y),
                                                                     static_cast<double>(size.x), static_cast<double>(size.y)}));
    }
}

}  // namespace

std::string describeCamera(const std::optional<Pose>& pose, const FieldOfView& field, const Lens& lens, const Projection& projection)
{
    std::string text;
    for (const auto& [name, value] : cameraOptions(pose, field, lens, projection)) {
        text += " " + name + "=" + value;
    }
    return text;
}

OptionTexts cameraOptions(const std::optional<Pose>& pose, const FieldOfView& field, const Lens& lens, const Projection& projection)
{
    OptionTexts words;
    if (pose) {
        words = {{"look-from", pointText(pose->from)}, {"look-at", pointText(pose->at)}, {"look-up", pointText(pose->up)}};
    }
    if (field.degrees) {
        words.emplace_back("fov", exactText(*field.degrees));
    }
    if (const double zoom = (pose ? pose->zoom : 1.0) * field.zoom; zoom != 1.0) {
        words.emplace_back("zoom", exactText(zoom));
    }
    if (lens.radius > 0.0F) {
        words.emplace_back("lens-radius", exactText(lens.radius));
        words.emplace_back("focal-distance", exactText(lens.focalDistance));
    }
    addProjection(projection, words);
    return words;
}

}  // namespace glim
