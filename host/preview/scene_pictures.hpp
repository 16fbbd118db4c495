// A scene's pictures: one of light, which has most of the layers, the same guided, and one of BVH steps.
#pragma once

#include "host/preview/refiner.hpp"
#include "host/preview/scene_loader.hpp"

#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace glim {

class ScenePictures {
public:
    // `settings` of all scenes, and the first `lens`; the size does not matter. Calls `beforeCompiling` whenever kernels are to be
    // compiled, which takes a while.
    ScenePictures(Device& device, const RenderSettings& settings, const Lens& lens, std::function<void()> beforeCompiling)
        : device_(device),
          settings_(settings),
          lens_(lens),
          beforeCompiling_(std::move(beforeCompiling))
    {}

    // Takes the scene in place of the one before, which stays if the new one is refused. show() follows.
    void enter(std::unique_ptr<LoadedScene> loaded);
    // The scene by other options. Kernels and what the options do not touch stay. If they are refused, throws InputError and changes
    // nothing. show() follows.
    void change(const LoadOptions& options, SplitRule split);
    // Of pictures that show() starts from now on.
    void setLens(const Lens& lens);
    const Lens& lens() const { return lens_; }
    // The same.
    void setWindowScale(std::uint32_t scale) { windowScale_ = scale; }
    bool isEmpty() const { return light_ == nullptr; }
    // Those of the picture of light.
    const RenderSettings& settings() const { return light_->renderer().settings(); }
    const PreparedScene& scene() const { return loaded_->prepared; }
    const SceneFile& file() const { return loaded_->file; }
    const LoadOptions& options() const { return loaded_->file.options(); }

    // What can be chosen: without a BVH there are no steps.
    std::vector<Aov> layers() const;
    Aov layer() const { return layer_; }
    // Shows another layer. `hasMoved`: the camera is another one than that of the last show(). Returns whether a new picture began.
    bool choose(Aov layer, const Camera& camera, const glm::uvec2& size, bool hasMoved);

    // Starts the picture of this camera in this size.
    void show(const Camera& camera, const glm::uvec2& size);
    // Starts the picture of light anew, by this guide of this camera and size. It goes unguided again with the next show().
    void guide(std::shared_ptr<const Guide> guide, const Camera& camera, const glm::uvec2& size);
    bool isGuided() const { return isGuided_; }
    // The picture of the chosen layer.
    Refiner& shown() const { return layer_ == Aov::BvhSteps ? *steps_ : isGuided_ ? *guided_ : *light_; }

private:
    void leaveOthers();

    Device& device_;
    RenderSettings settings_;
    Lens lens_;
    std::uint32_t windowScale_ = 1;  // as of Refiner
    std::function<void()> beforeCompiling_;
    std::unique_ptr<LoadedScene> loaded_;
    std::unique_ptr<Refiner> light_;
    std::unique_ptr<Refiner> steps_;   // made when it is first shown; shares light_'s buffers
    std::unique_ptr<Refiner> guided_;  // made of the first guide; the same
    bool isGuided_ = false;
    Aov layer_ = Aov::Radiance;
    bool lightIsStale_ = false;  // the camera has moved since light_ was last shown
};

}  // namespace glim
