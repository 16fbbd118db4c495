#include "host/render/light_path_gain.hpp"

#include "host/render/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace glim {
namespace {

// With two blocks of 32 samples, .4 % of 512x512 pixels of 64 samples.
constexpr double kPixels = 1024.0;
constexpr std::uint32_t kPatch = 8;  // pixels a side, over which radiance is averaged

RenderSettings smallSettings(const RenderSettings& settings)
{
    RenderSettings small = pilotSettings(settings, pilotSize(settings, kPixels));
    small.sampleEnd = 2 * kFirstBlockSamples;
    small.paths = settings.paths;
    small.comparesPaths = true;
    return small;
}

struct Patch {
    double pixels = 0.0, radiance = 0.0, caustic = 0.0;
    double rest = 0.0, light = 0.0, camera = 0.0;  // sums of variances, and of camera paths' second moment
};

double meanOf(const glm::vec3& color)
{
    return (static_cast<double>(color.r) + static_cast<double>(color.g) + static_cast<double>(color.b)) / 3.0;
}

// Of one sample.
template <class Moments>
double varianceOf(const Moments& moments)
{
    return moments.blocks > 1 ? meanOf(moments.squares) / (moments.blocks - 1.0) : 0.0;
}

}  // namespace

LightPathGain measureLightPaths(const Renderer& renderer, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
{
    const RenderSettings small = smallSettings(settings);
    Renderer pilot(renderer, scene, camera, small);
    const Film film = pilot.render([](const RenderProgress&) { return true; });
    const double unit = 1.0 / (static_cast<double>(splatScale(scene)) * static_cast<double>(kComparedShare));
    const std::uint32_t columns = (small.width + kPatch - 1) / kPatch;
    std::vector<Patch> patches(std::size_t{columns} * ((small.height + kPatch - 1) / kPatch));
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const std::size_t x = i % small.width, y = i / small.width;
        Patch& patch = patches[y / kPatch * columns + x / kPatch];
        const double caustic = meanOf(film.splats[i].mean), radiance = meanOf(film.pixels[i].mean) + caustic;
        patch.pixels += 1.0;
        patch.radiance += radiance;
        patch.caustic += caustic;
        patch.rest += varianceOf(film.pixels[i]);
        patch.light += varianceOf(film.splats[i]);
        patch.camera += unit * static_cast<double>(film.splats[i].clamped);
    }
    LightPathGain gain;
    for (const Patch& patch : patches) {
        const double radiance = patch.radiance / patch.pixels, caustic = patch.caustic / patch.pixels;
        if (radiance > 0.0) {
            const double weight = 1.0 / (radiance * radiance * static_cast<double>(film.pixels.size()));
            gain.rest += weight * patch.rest;
            gain.light += weight * patch.light;
            gain.camera += weight * std::max(0.0, patch.camera - patch.pixels * caustic * caustic);
        }
    }
    const RenderStatistics& statistics = pilot.statistics();
    const double rays = static_cast<double>(statistics.cameraAndBounceRays + statistics.shadowRays);
    const double light = static_cast<double>(statistics.lightPathRays);
    gain.work = light / std::max(1.0, rays - light);
    return gain;
}

bool choosesLightPaths(const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
                       const std::function<const Renderer&()>& makeRenderer)
{
    return !tracesLight(scene, settings) || scene.hasHiddenCaustics || measureLightPaths(makeRenderer(), scene, camera, settings).isGain();
}

bool choosesLightPaths(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
{
    std::optional<Renderer> renderer;
    return choosesLightPaths(scene, camera, settings,
                             [&]() -> const Renderer& { return renderer.emplace(device, scene, camera, smallSettings(settings)); });
}

}  // namespace glim
