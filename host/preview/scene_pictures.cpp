#include "host/preview/scene_pictures.hpp"

#include "host/error.hpp"

#include <utility>

namespace glim {

void ScenePictures::enter(std::unique_ptr<LoadedScene> loaded)
{
    beforeCompiling_();
    auto light = std::make_unique<Refiner>(device_, loaded->prepared, settings_, lens_);
    leaveOthers();
    light_ = std::move(light);
    loaded_ = std::move(loaded);
}

void ScenePictures::edit(const std::vector<Edit>& edits, SplitRule split)
{
    editScene(loaded_->prepared, loaded_->file, edits, loaded_->moment.seconds, split);
    renew();
}

void ScenePictures::pose(const Moment& moment, SplitRule split)
{
    LoadedScene& loaded = *loaded_;
    const auto update = [&](const Moment& at) {
        loaded.file.setAnimation(at.animation);
        updateScene(loaded.prepared, loaded.file, at.seconds, split);
    };
    try {
        update(moment);
    } catch (const InputError&) {
        loaded.file.setAnimation(loaded.moment.animation);
        if (loaded.prepared.bvh.nodes.empty()) {  // there was too little memory
            update(loaded.moment);
        }
        throw;
    }
    loaded.moment = moment;
    renew();
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

// After the scene has changed.
void ScenePictures::renew()
{
    leaveOthers();
    if (light_->needsKernels()) {
        beforeCompiling_();
    }
    light_->renew();
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
    RenderSettings settings = settings_;
    settings.guide = std::move(guide);
    guided_ = std::make_unique<Refiner>(guided_ ? *guided_ : *light_, loaded_->prepared, settings);
    guided_->showWhole(camera, size);
    isGuided_ = true;
}

void ScenePictures::show(const Camera& camera, const glm::uvec2& size)
{
    isGuided_ = false;
    if (shown().needsKernels(camera, size)) {
        beforeCompiling_();
    }
    shown().show(camera, size);
    lightIsStale_ = layer_ == Aov::BvhSteps;
}

}  // namespace glim
