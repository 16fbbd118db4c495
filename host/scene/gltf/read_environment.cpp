#include "host/scene/gltf/read_environment.hpp"

#include "host/error.hpp"
#include "host/scene/gltf/read_images.hpp"
#include "host/scene/gltf/read_lights.hpp"
#include "host/scene/make_studio.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glim {
namespace {

constexpr double kMaxFloat = std::numeric_limits<float>::max();

Environment readMap(const std::filesystem::path& path, DecodedParts& decoded, Scene& scene, Warnings& warnings)
{
    Environment environment;
    environment.map = decoded.findMap(path.string(), [&path] { return readRadianceMap(path); });
    environment.source = path.string();
    scene.files.push_back(path);
    if (environment.map->repaired > 0) {
        warnings.add({MessageId::RepairedTexels,
                      {part::file(path.string()), " holds ", part::value(counted(environment.map->repaired, "texel")),
                       " that are negative or not finite; they count as 0"}});
    }
    return environment;
}

// scenes[i].extras.environment: {"file", "strength"}.
std::optional<Environment> readNamedMap(const GltfFile& file, const LoadOptions& options, std::size_t index, DecodedParts& decoded,
                                        Scene& scene, Warnings& warnings)
{
    const tinygltf::Value& extras = file.model.scenes[index].extras;
    if (!extras.IsObject() || !extras.Has("environment")) {
        return std::nullopt;
    }
    const tinygltf::Value& source = extras.Get("environment");
    const std::string place = label("scenes", index, file.model.scenes[index].name) + ".extras.environment";
    if (!source.IsObject() || !source.Has("file") || !source.Get("file").IsString()) {
        warnings.add({MessageId::ExtrasIgnored, {part::place(place), " has no \"file\" and is ignored"}});
        return std::nullopt;
    }
    const std::string name = source.Get("file").Get<std::string>();
    if (options.confined) {
        refuseOutside(file.path, place, name);
    }
    Environment environment;
    try {
        environment = readMap(externalFile(file.path, name), decoded, scene, warnings);
    } catch (const InputError& error) {
        throw InputError(error, {part::file(file.path), ": ", part::place(place), " names the map ", part::quoted(name),
                                 ", which cannot be read (", error.what(), ")"});
    }
    if (source.Has("strength")) {
        const tinygltf::Value& strength = source.Get("strength");
        const double factor = strength.IsNumber() ? strength.GetNumberAsDouble() : -1.0;
        if (!(factor >= 0.0 && factor <= kMaxFloat)) {
            refuse(file, MessageId::OutOfRange,
                   {part::place(place + ".strength"), " is ", part::value(strength.IsNumber() ? toText(factor) : "not a number"),
                    "; expected ", part::expected("a number from 0 that fits a float")});
        }
        environment.radiance = glm::vec3(static_cast<float>(factor));
    }
    return environment;
}

std::optional<Environment> readFileEnvironment(const GltfFile& file, const LoadOptions& options, DecodedParts& decoded, Scene& scene,
                                               Warnings& warnings)
{
    if (file.model.scenes.empty()) {
        return std::nullopt;
    }
    const auto first = static_cast<std::size_t>(std::max(file.model.defaultScene, 0));
    const std::size_t index = options.scene.value_or(first);
    std::optional<Environment> environment = readNamedMap(file, options, index, decoded, scene, warnings);
    return environment ? environment : readImageLight(file, index, decoded, scene, warnings);
}

// As the options turn, scale and show it.
Environment adjusted(Environment environment, const LoadOptions& options)
{
    environment.rotation = glm::radians(options.environmentRotation);
    environment.radiance *= options.environmentStrength;
    environment.background = options.environmentBackground;
    return environment;
}

}  // namespace

Environment makeStudioEnvironment(const LoadOptions& options, DecodedParts& decoded)
{
    Environment environment;
    environment.source = "studio";
    environment.map = decoded.findMap(environment.source, makeStudio);
    return adjusted(environment, options);
}

std::optional<Environment> chooseEnvironment(const GltfFile& file, const LoadOptions& options, DecodedParts& decoded, Scene& scene,
                                             Warnings& warnings)
{
    if (options.environment == EnvironmentChoice(BuiltInEnvironment::Studio)) {
        return makeStudioEnvironment(options, decoded);
    }
    std::optional<Environment> environment;
    if (!options.environment) {
        environment = readFileEnvironment(file, options, decoded, scene, warnings);
    } else if (const auto* radiance = std::get_if<glm::vec3>(&*options.environment)) {
        environment.emplace().radiance = *radiance;
        environment->source = "constant";
    } else if (const auto* path = std::get_if<std::filesystem::path>(&*options.environment)) {
        environment = readMap(*path, decoded, scene, warnings);
    }
    return environment ? std::optional(adjusted(*environment, options)) : std::nullopt;
}

PunctualLight lightOf(const Sun& sun)
{
    const double azimuth = glm::radians(sun.azimuth), elevation = glm::radians(sun.elevation);
    PunctualLight light;
    light.name = "sun";
    light.kind = PunctualLight::Kind::Directional;
    light.direction =
        -glm::vec3(glm::dvec3(std::sin(azimuth) * std::cos(elevation), std::sin(elevation), -std::cos(azimuth) * std::cos(elevation)));
    light.intensity = glm::vec3(sun.irradiance);
    return light;
}

}  // namespace glim
