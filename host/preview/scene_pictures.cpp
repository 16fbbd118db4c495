#include "host/preview/scene_pictures.hpp"

#include <utility>

namespace glim {

void ScenePictures::enter(std::unique_ptr<PreparedScene> prepared)
{
    auto light = std::make_unique<Refiner>(device_, *prepared, settings_, lens_);
    steps_.reset();  // it uses buffers of light_
    light_ = std::move(light);
    prepared_ = std::move(prepared);
    if (layer_ == Aov::BvhSteps) {
        layer_ = Aov::Radiance;
    }
}

std::vector<Aov> ScenePictures::layers() const
{
    std::vector<Aov> layers = {Aov::Radiance, Aov::Normal, Aov::Depth, Aov::Albedo, Aov::SampleCount};
    if (settings_.course.accelerator != Accelerator::None) {
        layers.push_back(Aov::BvhSteps);
    }
    return layers;
}

bool ScenePictures::choose(Aov layer, const Camera& camera, const glm::uvec2& size, bool hasMoved)
{
    if (!isCompiled(layer)) {
        RenderSettings settings = settings_;
        settings.aov = Aov::BvhSteps;
        settings.bounces = 0;
        settings.adaptive = Adaptive::Off;
        steps_ = std::make_unique<Refiner>(*light_, *prepared_, settings);
    }
    const bool isStale = lightIsStale_ || hasMoved, leavesSteps = std::exchange(layer_, layer) == Aov::BvhSteps;
    const bool entersSteps = layer_ == Aov::BvhSteps, begins = entersSteps || (leavesSteps && isStale);
    if (begins) {
        show(camera, size);
    }
    lightIsStale_ = entersSteps && isStale;
    return begins;
}

void ScenePictures::show(const Camera& camera, const glm::uvec2& size)
{
    shown().show(camera, size);
    lightIsStale_ = layer_ == Aov::BvhSteps;
}

}  // namespace glim
