#include "host/render/parameters.hpp"

#include <algorithm>

namespace glim {

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

DeviceParameters::DeviceParameters(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : buffer_(device, "render's parameters", BufferKind::Storage, sizeof(RenderParameters))
{
    const PathLengths lengths = pathLengths(settings);
    parameters_.seed = settings.seed;
    parameters_.maxBounces = lengths.maxBounces;
    parameters_.minPathLength = lengths.min;
    parameters_.maxPathLength = lengths.max;
    parameters_.lightCount = static_cast<std::uint32_t>(scene.lights.size());
    parameters_.finiteLights = scene.finiteLights;
    parameters_.finiteShare = scene.finiteShare;
    parameters_.environmentLight = scene.environmentLight;
    parameters_.environment = scene.environment;
    parameters_.clampIndirect = settings.clampIndirect;
    parameters_.canarySteps = 3;
    parameters_.triangleCount = scene.triangleCount;
    parameters_.firstUv = scene.firstUv;
    parameters_.firstTangent = scene.firstTangent;
    parameters_.firstColor = scene.firstColor;
    parameters_.firstMedium = scene.firstMedium;
    parameters_.hidesEnvironment = scene.hidesEnvironment ? 1 : 0;
    parameters_.environmentSize = scene.environmentSize;
    parameters_.environmentCells = scene.environmentCellCount;
    parameters_.environmentTurn = scene.environmentTurn;
    setCamera(camera, settings.width, settings.height);
}

void DeviceParameters::setCamera(const FlatCamera& camera, std::uint32_t width, std::uint32_t height)
{
    parameters_.camera = camera;
    parameters_.width = width;
    parameters_.height = height;
    upload(buffer_, std::span<const RenderParameters>(&parameters_, 1));
}

void DeviceParameters::setSeed(std::uint32_t seed)
{
    parameters_.seed = seed;
    upload(buffer_, std::span<const RenderParameters>(&parameters_, 1));
}

}  // namespace glim
