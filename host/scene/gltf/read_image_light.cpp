#include "host/scene/gltf/read_lights.hpp"

#include "host/error.hpp"
#include "host/image/srgb.hpp"
#include "host/scene/gltf/read_images.hpp"
#include "host/text.hpp"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

using std::numbers::pi;

constexpr const char* kImageLight = "EXT_lights_image_based";

// Linear texels, rows from the top. Seen from inside the cube they are not mirrored: the extension flips OpenGL's faces about their
// vertical axes.
struct Face {
    std::uint32_t size = 0;
    std::vector<glm::vec3> texels;

    const glm::vec3& at(int x, int y) const
    {
        const int last = static_cast<int>(size) - 1;
        return texels[static_cast<std::size_t>(std::clamp(y, 0, last)) * size + static_cast<std::size_t>(std::clamp(x, 0, last))];
    }
};
using Cube = std::array<Face, 6>;  // +x, -x, +y, -y, +z, -z

// A PNG with alpha is RGBD: a colour, encoded like any other of glTF, divided by alpha. The extension does not name the encoding; the
// renderer that its authors wrote it for (Babylon.js) decodes before it divides.
glm::vec3 radianceOf(const DecodedImage& image, std::size_t texel)
{
    glm::dvec4 t;
    for (int c = 0; c < 4; ++c) {
        const std::size_t at = 4 * texel + static_cast<std::size_t>(c);
        t[c] = image.rgba16.empty() ? image.rgba8[at] / 255.0 : image.rgba16[at] / 65535.0;
    }
    const double divisor = image.hasAlpha ? std::max(t.a, 1.0 / 255.0) : 1.0;
    return glm::dvec3(linearFromSrgb(t.r), linearFromSrgb(t.g), linearFromSrgb(t.b)) / divisor;
}

// Bilinear within the face that `w` points to.
glm::vec3 sampleCube(const Cube& cube, const glm::dvec3& w)
{
    const glm::dvec3 a = glm::abs(w);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const bool negative = w[axis] < 0.0;
    const double side = negative ? -1.0 : 1.0;
    // To the right and downwards in the face, from -1 to 1.
    const glm::dvec2 place = (axis == 0   ? glm::dvec2(side * w.z, -w.y)
                              : axis == 1 ? glm::dvec2(-w.x, side * w.z)
                                          : glm::dvec2(-side * w.x, -w.y)) /
                             a[axis];
    const Face& face = cube[static_cast<std::size_t>(2 * axis + (negative ? 1 : 0))];
    const glm::dvec2 texel = (0.5 * place + 0.5) * static_cast<double>(face.size) - 0.5;
    const int x = static_cast<int>(std::floor(texel.x)), y = static_cast<int>(std::floor(texel.y));
    const auto u = static_cast<float>(texel.x - x), v = static_cast<float>(texel.y - y);
    return glm::mix(glm::mix(face.at(x, y), face.at(x + 1, y), u), glm::mix(face.at(x, y + 1), face.at(x + 1, y + 1), u), v);
}

// A texel is the mean of four look-ups.
RadianceMap unrollCube(const Cube& cube, const glm::dquat& worldFromCube)
{
    RadianceMap map;
    map.height = std::min(2 * cube[0].size, kMaxMapWidth / 4);
    map.width = 2 * map.height;
    map.texels.reserve(std::size_t{map.width} * map.height);
    const glm::dquat cubeFromWorld = glm::conjugate(worldFromCube);
    for (std::uint32_t y = 0; y < map.height; ++y) {
        for (std::uint32_t x = 0; x < map.width; ++x) {
            glm::vec3 sum(0.0F);
            for (int k = 0; k < 4; ++k) {
                const double azimuth = 2.0 * pi * ((x + 0.25 + 0.5 * (k % 2)) / map.width - 0.5);
                const double polar = pi * (y + 0.25 + 0.5 * (k / 2)) / map.height;
                const double sine = std::sin(polar);
                sum += sampleCube(cube, cubeFromWorld * glm::dvec3(std::sin(azimuth) * sine, std::cos(polar), -std::cos(azimuth) * sine));
            }
            map.texels.push_back(0.25F * sum);
        }
    }
    return map;
}

Face readFace(const GltfFile& file, const std::string& place, std::size_t image, Scene& scene, Warnings& warnings)
{
    const DecodedImage pixels = readImage(file, image, scene, warnings);
    if (pixels.width != pixels.height) {
        refuse(file, MessageId::Mismatch,
               {part::place(place), " is ", part::value(std::to_string(pixels.width) + "x" + std::to_string(pixels.height)),
                " pixels; expected ", part::expected("a square")});
    }
    Face face;
    face.size = pixels.width;
    const std::size_t texels = std::size_t{pixels.width} * pixels.height;
    face.texels.reserve(texels);
    for (std::size_t i = 0; i < texels; ++i) {
        face.texels.push_back(radianceOf(pixels, i));
    }
    return face;
}

Cube readCube(const GltfFile& file, const tinygltf::Value& light, const std::string& place, Scene& scene, Warnings& warnings)
{
    const tinygltf::Value& levels = light.Get("specularImages");
    const bool whole = levels.ArrayLen() > 0 && levels.Get(0).IsArray() && levels.Get(0).ArrayLen() == 6;
    if (!whole) {
        refuse(file, MessageId::Mismatch,
               {part::place(place + ".specularImages[0]"), " has not six images; expected ", part::expected("the faces of a cube")});
    }
    Cube cube;
    for (std::size_t i = 0; i < cube.size(); ++i) {
        const std::string at = place + ".specularImages[0][" + std::to_string(i) + "]";
        cube[i] = readFace(file, at, static_cast<std::size_t>(levels.Get(0).Get(static_cast<int>(i)).GetNumberAsInt()), scene, warnings);
        if (cube[i].size != cube[0].size) {
            refuse(file, MessageId::Mismatch,
                   {part::place(at), " is ", part::value(std::to_string(cube[i].size)), " pixels wide; expected ",
                    part::expected(std::to_string(cube[0].size) + " as the first face")});
        }
    }
    return cube;
}

glm::dquat readLightRotation(const GltfFile& file, const tinygltf::Value& light, const std::string& place)
{
    if (!light.Has("rotation")) {
        return {1.0, 0.0, 0.0, 0.0};
    }
    const auto number = [&light](int i) { return light.Get("rotation").Get(i).GetNumberAsDouble(); };
    const glm::dquat rotation(number(3), number(0), number(1), number(2));
    if (!(glm::length(rotation) > 0.0)) {
        refuse(file, MessageId::Degenerate,
               {part::place(place + ".rotation"), " is ", part::value("0"), "; expected ", part::expected("a unit quaternion")});
    }
    return glm::normalize(rotation);
}

}  // namespace

std::optional<Environment> readImageLight(const GltfFile& file, std::size_t sceneOfFile, DecodedParts& decoded, Scene& scene,
                                          Warnings& warnings)
{
    const auto use = file.model.scenes[sceneOfFile].extensions.find(kImageLight);
    if (use == file.model.scenes[sceneOfFile].extensions.end()) {
        return std::nullopt;
    }
    const int index = use->second.Get("light").GetNumberAsInt();
    const tinygltf::Value& light = file.model.extensions.at(kImageLight).Get("lights").Get(index);
    const std::string place = std::string("extensions.") + kImageLight + ".lights[" + std::to_string(index) + "]";
    Environment environment;
    const glm::dquat rotation = readLightRotation(file, light, place);
    const std::string name =
        place + " " + exactText(rotation.w) + "," + exactText(rotation.x) + "," + exactText(rotation.y) + "," + exactText(rotation.z);
    environment.map = decoded.findMap(name, [&] { return unrollCube(readCube(file, light, place, scene, warnings), rotation); });
    environment.source = kImageLight;
    environment.radiance = glm::vec3(light.Has("intensity") ? static_cast<float>(light.Get("intensity").GetNumberAsDouble()) : 1.0F);
    return environment;
}

}  // namespace glim
