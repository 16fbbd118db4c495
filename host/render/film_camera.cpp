#include "host/render/film_camera.hpp"

#include "host/json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace glim {
namespace {

using Model = Projection::Model;

Json matrixOf(const Camera& camera, const glm::dvec3& sceneOrigin)
{
    const glm::dvec3 right(camera.right), up(camera.up), back(-camera.forward), from = glm::dvec3(camera.position) + sceneOrigin;
    Json rows = Json::array();
    for (int k = 0; k < 3; ++k) {
        rows.append(Json::array({right[k], up[k], back[k], from[k]}));
    }
    rows.append(Json::array({0.0, 0.0, 0.0, 1.0}));
    return rows;
}

Json intrinsicsOf(const Camera& camera, const glm::dvec2& size)
{
    const Projection& projection = camera.projection;
    const double focal = 0.5 * size.y / std::tan(0.5 * static_cast<double>(camera.yfov));
    const Intrinsics own{glm::dvec2(focal), 0.5 * size, size};
    const Intrinsics& used = projection.intrinsics ? *projection.intrinsics : own;
    const glm::dvec2 shift = projection.shift * std::max(size.x, size.y) * glm::dvec2(-1.0, 1.0);
    const glm::dvec2 center = used.center + shift - (projection.crop ? glm::dvec2(projection.crop->corner) : glm::dvec2(0.0));
    return Json::array(
        {Json::array({used.focal.x, 0.0, center.x}), Json::array({0.0, used.focal.y, center.y}), Json::array({0.0, 0.0, 1.0})});
}

const char* kindOf(const Camera& camera)
{
    return camera.projection.model == Model::Equirectangular ? "equirectangular"
           : camera.projection.model == Model::Fisheye       ? "fisheye"
           : camera.kind == Camera::Kind::Orthographic       ? "orthographic"
                                                             : "perspective";
}

}  // namespace

std::string describeFilmCamera(const Camera& camera, const glm::uvec2& size, const glm::dvec3& sceneOrigin, std::optional<double> time)
{
    const Projection& projection = camera.projection;
    const std::span<const double> distortion(projection.distortion);
    Json json{{"kind", kindOf(camera)}, {"pose", matrixOf(camera, sceneOrigin)}};
    const bool isEquirectangular = projection.model == Model::Equirectangular;
    if (!isEquirectangular && camera.kind == Camera::Kind::Orthographic) {
        json.set("halfSize", Json::array({camera.halfWidth, camera.halfHeight}));
    } else if (!isEquirectangular) {
        json.set("K", intrinsicsOf(camera, glm::dvec2(projection.crop ? projection.crop->whole : size)));
    }
    if (projection.model == Model::RadialTangential) {
        json.set("distortion", distortion);
    } else if (projection.model == Model::Fisheye) {
        json.set("fisheye", distortion.first(4));
    }
    if (const std::optional<Crop>& crop = projection.crop) {
        json.set("crop", Json::array({crop->corner.x, crop->corner.y, crop->size.x, crop->size.y}));
        json.set("whole", Json::array({crop->whole.x, crop->whole.y}));
    }
    if (time) {
        json.set("time", *time);
    }
    return json.dump();
}

std::optional<glm::mat4> worldToCameraOf(const std::string& description)
{
    const std::optional<Json> json = Json::parse(description);
    const Json* pose = json ? json->find("pose") : nullptr;
    if (pose == nullptr) {
        return std::nullopt;
    }
    glm::dmat4 worldFromCamera(1.0);
    try {
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column) {
                worldFromCamera[column][row] = pose->at(static_cast<std::size_t>(row)).at(static_cast<std::size_t>(column)).number();
            }
        }
    } catch (const JsonError&) {
        return std::nullopt;
    }
    return glm::mat4(glm::transpose(glm::inverse(worldFromCamera)));
}

}  // namespace glim
