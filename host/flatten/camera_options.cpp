#include "host/flatten/camera_options.hpp"

#include "host/text.hpp"

#include <utility>
#include <vector>

namespace glim {
namespace {

using OptionValues = std::vector<std::pair<std::string, std::string>>;

std::string pointText(const glm::dvec3& v) { return exactText(v.x) + "," + exactText(v.y) + "," + exactText(v.z); }

OptionValues listOptions(const std::optional<Pose>& pose, const FieldOfView& field, const Lens& lens)
{
    OptionValues words;
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
    return words;
}

std::string join(const OptionValues& words, const char* before, const char* between)
{
    std::string text;
    for (const auto& [name, value] : words) {
        text += before + name + between + value;
    }
    return text;
}

}  // namespace

std::string describeCamera(const std::optional<Pose>& pose, const FieldOfView& field, const Lens& lens)
{
    return join(listOptions(pose, field, lens), " ", "=");
}

std::string cameraOptions(const std::optional<Pose>& pose, const FieldOfView& field, const Lens& lens)
{
    return join(listOptions(pose, field, lens), " --", " ");
}

}  // namespace glim
