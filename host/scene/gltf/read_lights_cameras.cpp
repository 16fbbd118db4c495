#include "host/scene/gltf/read_lights.hpp"

#include "host/scene/gltf/gltf_schema.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace glim {
namespace {

// 1 - cos, without cancellation.
float versine(double angle) { return static_cast<float>(2.0 * std::pow(std::sin(0.5 * angle), 2.0)); }

glm::vec3 readPosition(const GltfFile& file, const PlacedNode& node, const Scene& scene)
{
    const glm::vec3 position(glm::dvec3(node.worldFromNode[3]) - scene.origin);
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z)) {
        refuse(file, MessageId::OutOfRange,
               {part::place(nodeLabel(file, node.index)), " is not at a finite place; expected ",
                part::expected("coordinates that fit a float")});
    }
    return position;
}

std::string chooseName(const GltfFile& file, const PlacedNode& node, const std::string& own)
{
    const std::string& name = file.model.nodes[node.index].name;
    return name.empty() ? own : name;
}

// Cones that are equal make a hard edge, which is a ramp over the last step of a float.
void readCones(const GltfFile& file, const tinygltf::SpotLight& spot, const std::string& place, PunctualLight& light, Warnings& warnings)
{
    const double inner = spot.innerConeAngle, outer = spot.outerConeAngle;
    if (inner > outer + kFileRounding * outer) {
        refuse(file, MessageId::OutOfRange,
               {part::place(place), " has the inner cone angle ", part::value(toText(inner)), "; expected ",
                part::expected("at most the outer one, " + toText(outer))});
    }
    if (static_cast<float>(inner) > static_cast<float>(outer)) {
        warnings.add(MessageId::ConeClamped, "inner cones that rounding has made larger than the outer ones are clamped", place);
    }
    light.versineOuter = std::max(versine(outer), FLT_MIN);
    light.versineInner = std::min(versine(inner), std::nextafter(light.versineOuter, 0.0F));
}

PunctualLight readLight(const GltfFile& file, const PlacedNode& node, std::size_t index, const Scene& scene, Warnings& warnings)
{
    const tinygltf::Light& source = file.model.lights[index];
    const std::string place = label("lights", index, source.name);
    PunctualLight light;
    light.name = chooseName(file, node, source.name);
    light.position = readPosition(file, node, scene);
    light.direction = -glm::normalize(readAxes(file, node)[2]);
    for (int c = 0; c < 3; ++c) {
        const double color = source.color.empty() ? 1.0 : source.color[static_cast<std::size_t>(c)];
        light.intensity[c] = static_cast<float>(source.intensity * color);
        if (!std::isfinite(light.intensity[c])) {
            refuse(file, MessageId::OutOfRange,
                   {part::place(place), " has the intensity ", part::value(toText(source.intensity)), " and the colour ", toText(color),
                    "; expected ", part::expected("a product that fits a float")});
        }
    }
    if (source.type == "point") {
        light.kind = PunctualLight::Kind::Point;
    } else if (source.type == "directional") {
        light.kind = PunctualLight::Kind::Directional;
    } else {
        light.kind = PunctualLight::Kind::Spot;
        readCones(file, source.spot, place, light, warnings);
    }
    if (source.range > 0.0) {
        light.range = static_cast<float>(source.range);
    }
    return light;
}

// A camera's transform is a rotation and a translation: glTF gives scale no meaning here.
void readCameraPose(const GltfFile& file, const PlacedNode& node, Camera& camera)
{
    const glm::dmat3 linear = readAxes(file, node);
    const glm::dvec3 forward = -glm::normalize(linear[2]);
    const glm::dvec3 up = glm::normalize(linear[1] - forward * glm::dot(forward, linear[1]));
    camera.forward = forward;
    camera.up = up;
    camera.right = glm::cross(forward, up);
}

Camera readCamera(const GltfFile& file, const PlacedNode& node, std::size_t index, const Scene& scene, Warnings& warnings)
{
    const tinygltf::Camera& source = file.model.cameras[index];
    Camera camera;
    camera.name = chooseName(file, node, source.name);
    camera.position = readPosition(file, node, scene);
    readCameraPose(file, node, camera);
    if (glm::determinant(glm::dmat3(node.worldFromNode)) < 0.0) {
        warnings.add(MessageId::MirroredCamera, "mirrored cameras are drawn upright", nodeLabel(file, node.index));
    }
    if (source.type == "perspective") {
        camera.yfov = static_cast<float>(source.perspective.yfov);
        if (source.perspective.aspectRatio > 0.0) {
            camera.aspectRatio = static_cast<float>(source.perspective.aspectRatio);
        }
    } else {
        camera.kind = Camera::Kind::Orthographic;
        camera.halfWidth = static_cast<float>(source.orthographic.xmag);
        camera.halfHeight = static_cast<float>(source.orthographic.ymag);
        if (camera.halfWidth == 0.0F || camera.halfHeight == 0.0F) {
            refuse(file, MessageId::OutOfRange,
                   {part::place(label("cameras", index, source.name)), " has the xmag ", part::value(toText(source.orthographic.xmag)),
                    " and the ymag ", toText(source.orthographic.ymag), "; expected ", part::expected("numbers other than 0")});
        }
        camera.aspectRatio = static_cast<float>(std::abs(source.orthographic.xmag / source.orthographic.ymag));
    }
    if (const float ratio = camera.aspectRatio.value_or(1.0F); !(ratio <= kMaxAspectRatio && ratio * kMaxAspectRatio >= 1.0F)) {
        warnings.add(MessageId::ExtremeAspectRatio,
                     "cameras of an aspect ratio beyond 16:1 or 1:16 get a picture of that shape, unless --size says another",
                     nodeLabel(file, node.index) + " " + toText(static_cast<double>(ratio)));
    }
    return camera;
}

}  // namespace

void readLightsAndCameras(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene, Warnings& warnings)
{
    for (const PlacedNode& node : nodes) {
        const tinygltf::Node& source = file.model.nodes[node.index];
        if (const auto light = source.extensions.find("KHR_lights_punctual"); light != source.extensions.end() && node.visible) {
            const auto index = static_cast<std::size_t>(light->second.Get("light").GetNumberAsInt());
            scene.lights.push_back(readLight(file, node, index, scene, warnings));
        }
        if (source.camera >= 0) {
            scene.cameras.push_back(readCamera(file, node, static_cast<std::size_t>(source.camera), scene, warnings));
        }
    }
}

}  // namespace glim
