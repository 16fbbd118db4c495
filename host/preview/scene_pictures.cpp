#include "host/preview/scene_pictures.hpp"

#include "host/error.hpp"
#include "host/render/parameters.hpp"

#include <utility>

namespace glim {

void ScenePictures::enter(std::unique_ptr<LoadedScene> loaded)
{
    beforeCompiling_();
    auto light = std::make_unique<Refiner>(device_, loaded->prepared, catchingSettings(loaded->prepared.flat, settings_), lens_);
    leaveOthers();
    light_ = std::move(light);
    loaded_ = std::move(loaded);
}

void ScenePictures::change(const LoadOptions& options, SplitRule split)
{
    changeScene(loaded_->prepared, loaded_->file, options, split);
    leaveOthers();
    const RenderSettings wanted = catchingSettings(loaded_->prepared.flat, settings_);
    if (wanted.catcher != settings().catcher) {
        beforeCompiling_();
        light_.reset();  // so that no two scenes are on the device
        light_ = std::make_unique<Refiner>(device_, loaded_->prepared, wanted, lens_);
        return;
    }
    if (light_->needsKernels()) {
        beforeCompiling_();
    }
    light_->renew();
}

void ScenePictures::setLens(const Lens& lens)
{
    lens_ = lens;
    for (const auto& refiner : {&light_, &steps_, &guided_}) {
        if (*refiner) {
            (*refiner)->setLens(lens);
        }
    }
}

// They use buffers of light_.
void ScenePictures::leaveOthers()
{
    steps_.reset();
    guided_.reset();
    isGuided_ = false;
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
    if (layer == Aov::BvhSteps && !steps_) {
        beforeCompiling_();
        RenderSettings settings = settings_;
        settings.aov = Aov::BvhSteps;
        settings.bounces = 0;
        settings.adaptive = Adaptive::Off;
        settings.halves = false;
        steps_ = std::make_unique<Refiner>(*light_, loaded_->prepared, settings);
    }
    const bool isStale = lightIsStale_ || hasMoved, leavesSteps = std::exchange(layer_, layer) == Aov::BvhSteps;
    const bool entersSteps = layer_ == Aov::BvhSteps, begins = entersSteps || (leavesSteps && isStale);
    if (begins) {
        show(camera, size);
    }
    lightIsStale_ = entersSteps && isStale;
    return begins;
}

void ScenePictures::guide(std::shared_ptr<const Guide> guide, const Camera& camera, const glm::uvec2& size)
{
    if (!guided_) {
        beforeCompiling_();
    }
    RenderSettings settings = catchingSettings(loaded_->prepared.flat, settings_);
    settings.guide = std::move(guide);
    guided_ = std::make_unique<Refiner>(guided_ ? *guided_ : *light_, loaded_->prepared, settings);
    guided_->setWindowScale(windowScale_);
    guided_->showWhole(camera, size);
    isGuided_ = true;
}

void ScenePictures::show(const Camera& camera, const glm::uvec2& size)
{
    isGuided_ = false;
    if (shown().needsKernels(camera, size)) {
        beforeCompiling_();
    }
    shown().setWindowScale(windowScale_);
    shown().show(camera, size);
    lightIsStale_ = layer_ == Aov::BvhSteps;
}

}  // namespace glim
