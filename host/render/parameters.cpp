#include "host/render/parameters.hpp"

#include "host/render/course.hpp"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

// The course's estimators and AOVs add no more than a sample's light to the film.
bool keepsMore(const RenderSettings& settings)
{
    return settings.aov == Aov::Radiance && !usesCourseEstimators(settings) && !isCourse(settings.adaptive);
}

}  // namespace

PathLengths pathLengths(const RenderSettings& settings)
{
    PathLengths lengths{0, settings.bounces, 0};
    switch (settings.paths) {
    case PathParts::All: break;
    case PathParts::Emission: lengths.max = 0; break;
    case PathParts::Direct: lengths.min = lengths.max = 1; break;
    case PathParts::Indirect: lengths.min = 2; break;
    }
    lengths.maxBounces = settings.aov == Aov::Radiance ? std::min(settings.bounces, lengths.max) : 0;
    return lengths;
}

bool tracesLight(const FlatScene& scene, const RenderSettings& settings)
{
    return (scene.features & kFeatureCaustics) != 0 && settings.caustics && !settings.catcher && settings.aov == Aov::Radiance &&
           pathLengths(settings).maxBounces >= 2 && !usesCourseEstimators(settings) && !isCourse(settings.adaptive);
}

bool keepsGroups(const FlatScene& scene, const RenderSettings& settings)
{
    return (scene.features & kFeatureLightGroups) != 0 && keepsMore(settings);
}

bool catches(const FlatScene& scene, const RenderSettings& settings)
{
    return (scene.features & kFeatureCatcher) != 0 && keepsMore(settings);
}

RenderSettings catchingSettings(const FlatScene& scene, RenderSettings settings)
{
    settings.catcher = catches(scene, settings);
    settings.halves = settings.halves && !settings.catcher;
    return settings;
}

float splatScale(const FlatScene& scene)
{
    if (!(scene.brightness > 0.0F) || !std::isfinite(scene.brightness)) {
        return 0x1p32F;
    }
    return std::exp2(static_cast<float>(std::clamp(32 - std::ilogb(scene.brightness), -100, 100)));
}

DeviceParameters::DeviceParameters(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
                                   std::optional<float> time)
    : buffer_(device, "render's parameters", BufferKind::Storage, sizeof(RenderParameters))
{
    const PathLengths lengths = pathLengths(settings);
    parameters_.seed = settings.seed;
    parameters_.maxBounces = lengths.maxBounces;
    parameters_.minPathLength = lengths.min;
    parameters_.maxPathLength = lengths.max;
    parameters_.lightCount = static_cast<std::uint32_t>(scene.lights.size());
    parameters_.finiteLights = scene.finiteLights;
    parameters_.infiniteImportance = scene.infiniteImportance;
    parameters_.environmentLight = scene.environmentLight;
    parameters_.environment = scene.environment;
    parameters_.clampIndirect = settings.clampIndirect;
    parameters_.canarySteps = 3;
    parameters_.triangleCount = scene.triangleCount;
    parameters_.instanceCount = static_cast<std::uint32_t>(scene.instances.size() / kInstanceTexels);
    parameters_.firstInstanceRef = scene.firstInstanceRef;
    parameters_.firstUv = scene.firstUv;
    parameters_.firstTangent = scene.firstTangent;
    parameters_.firstColor = scene.firstColor;
    parameters_.firstMedium = scene.firstMedium;
    parameters_.firstScattering = scene.firstScattering;
    parameters_.hidesEnvironment = scene.hidesEnvironment || settings.catcher ? 1 : 0;
    parameters_.darkensObjects = settings.catcher && !settings.catcherReflections ? 1 : 0;
    parameters_.environmentSize = scene.environmentMap->size;
    parameters_.environmentCells = scene.environmentMap->cellCount;
    parameters_.environmentRotation = scene.environmentRotation;
    parameters_.environmentSplit = scene.environmentMap->split;
    parameters_.brightCells = static_cast<std::uint32_t>(scene.environmentMap->brightCells.size());
    parameters_.causticTargets = scene.causticTargets;
    parameters_.causticLights = scene.causticLights;
    parameters_.splatScale = splatScale(scene);
    parameters_.comparesPaths = settings.comparesPaths ? 1 : 0;
    parameters_.timeBegin = time.value_or(0.0F);
    parameters_.timeSpan = time ? 0.0F : 1.0F;
    parameters_.lightGroups = static_cast<std::uint32_t>(settings.lightGroups.size());
    setCamera(camera, settings.width, settings.height);
}

void DeviceParameters::setCamera(const FlatCamera& camera, std::uint32_t width, std::uint32_t height)
{
    parameters_.camera = camera;
    parameters_.width = width;
    parameters_.height = height;
    parameters_.lightPaths = lightPathCount(width, height);
    upload(buffer_, std::span<const RenderParameters>(&parameters_, 1));
}

void DeviceParameters::setSeed(std::uint32_t seed)
{
    parameters_.seed = seed;
    upload(buffer_, std::span<const RenderParameters>(&parameters_, 1));
}

}  // namespace glim
