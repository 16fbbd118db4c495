// A picture that refines. While the camera moves it has few large pixels, so that it follows at once; then it gets all of them.
#pragma once

#include "host/clock.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/prepare_scene.hpp"
#include "host/render/renderer.hpp"

#include <memory>

namespace glim {

class Refiner {
public:
    // Uploads the scene, which must stay, and compiles the kernels. The size in `settings` does not matter.
    Refiner(Device& device, const PreparedScene& prepared, const RenderSettings& settings, const Lens& lens);
    // Shares the resources of `other`, which is of the same scene and must outlive this one.
    Refiner(const Refiner& other, const PreparedScene& prepared, const RenderSettings& settings);

    // Whether kernels must be compiled for the scene, which has changed, or for this camera.
    bool needsKernels() const { return !renderer_.resources().hasKernels(prepared_.flat, camera_); }
    bool needsKernels(const Camera& camera, const glm::uvec2& size) const;
    // Of pictures that start from now on.
    void setLens(const Lens& lens) { lens_ = lens; }
    // The same. Pictures of moves are at least so much smaller, a power of two: the window shows no more.
    void setWindowScale(std::uint32_t scale) { windowScale_ = scale; }
    // To be called when the scene has changed. Kernels and buffers that serve it stay; show() follows.
    void renew();
    // Starts the picture of this camera in this size. It is coarse at first, since the camera may move on.
    void show(const Camera& camera, const glm::uvec2& size);
    // The same in full size at once, for a camera that rests.
    void showWhole(const Camera& camera, const glm::uvec2& size);
    // Works for about 100 ms, but ends earlier once `shouldContinue` returns false or a coarse picture is complete. Returns false if
    // there is nothing to do. If `paused`, it works only while some pixel has no sample.
    bool refine(bool paused, const std::function<bool()>& shouldContinue);

    // To be called while the picture is refined: keeps the halves of its samples once it has been left alone for a second. Before that they
    // would cost copies that a user who moves has no use for. Returns whether they are kept.
    bool keepHalves();
    // Whether the picture in full size has been left alone for a second.
    bool isAlone() const;

    // Whether the first picture since show() is still incomplete.
    bool isFresh() const { return fresh_; }
    // Whether every pixel has all its samples, or the time is up.
    bool isDone() const;
    // The samples of each pixel of the picture in full size; 0 while it is coarse.
    std::uint32_t sampleCount() const { return scale_ == 1 ? renderer_.plan().sampleCount() : 0; }
    std::uint32_t scale() const { return scale_; }  // the side of a film pixel in pixels of the picture
    // Those of a picture that has as many pixels as the window can show; 0 while it has fewer or more.
    std::uint32_t windowSampleCount() const { return scale_ == windowScale_ ? renderer_.plan().sampleCount() : 0; }
    double seconds() const { return seconds_; }  // spent on the picture
    double samplesPerSecond() const { return speed_; }
    const FlatCamera& camera() const { return camera_; }
    Renderer& renderer() { return renderer_; }

private:
    static constexpr std::uint32_t kCoarsest = 8;  // relative to windowScale_
    void aim(const Camera& camera, const glm::uvec2& size);
    FlatCamera flatten(const Camera& camera, const glm::uvec2& size) const;
    void chooseMovingScale(double seconds);
    std::uint32_t nextScale() const;
    void begin(std::uint32_t scale, bool fresh);
    void advance(const std::function<bool()>& shouldContinue);

    RenderSettings settings_;
    const PreparedScene& prepared_;
    Lens lens_;
    FlatCamera camera_;
    glm::uvec2 size_{1, 1};
    std::uint32_t scale_ = 1, windowScale_ = 1;
    bool fresh_ = false;
    std::uint32_t movingScale_ = kCoarsest;  // the scale of the next coarse picture, relative to windowScale_
    double speed_ = 0.0;                     // recent samples per second; 0: unknown
    double seconds_ = 0.0;
    Clock::time_point moved_;
    Renderer renderer_;
};

}  // namespace glim
