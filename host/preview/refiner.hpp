// A picture that refines: coarse while the camera moves, so that it follows at once, then pixel by pixel.
#pragma once

#include "host/flatten/flatten_scene.hpp"
#include "host/render/prepare_scene.hpp"
#include "host/render/renderer.hpp"

#include <chrono>
#include <memory>

namespace glim {

class Refiner {
public:
    // Uploads and compiles. `settings` without size; --view bvh-steps may be among them.
    Refiner(Device& device, const PreparedScene& prepared, const RenderSettings& settings, const Lens& lens);
    // Of the same scene, with its buffers; `lender` must outlive it.
    Refiner(const Refiner& lender, const PreparedScene& prepared, const RenderSettings& settings);

    // From now on this camera's picture, of this size; at first coarse, since more moves may follow.
    void show(const Camera& camera, const glm::uvec2& size);
    // Works for some 100 ms, or less once `goesOn` is false, or until a coarse picture is whole; false if there is nothing to do. If
    // `paused`, only as long as some pixel has no sample.
    bool refine(bool paused, const std::function<bool()>& goesOn);

    // Whether what moved is not to be seen yet: the first, mostly coarse, picture since show() is not whole.
    bool isFresh() const { return fresh_; }
    // Whether every pixel has had its samples, or its time.
    bool isDone() const;
    // Samples that every pixel of the full size has.
    std::uint32_t sampleCount() const { return scale_ == 1 ? renderer_.sampleCount() : 0; }
    std::uint32_t scale() const { return scale_; }  // pixels of the picture along a side of the film's
    double seconds() const { return seconds_; }     // of work on the picture
    double samplesPerSecond() const { return speed_; }
    const FlatCamera& camera() const { return camera_; }
    Renderer& renderer() { return renderer_; }

private:
    static constexpr std::uint32_t kCoarsest = 8;
    using Clock = std::chrono::steady_clock;

    void chooseMovingScale(double seconds);
    void begin(std::uint32_t scale, bool fresh);
    void advance(const std::function<bool()>& goesOn);

    RenderSettings settings_;
    Lens lens_;
    FlatCamera camera_;
    glm::uvec2 size_{1, 1};
    std::uint32_t scale_ = 1;
    bool fresh_ = false;
    std::uint32_t movingScale_ = kCoarsest;  // of the next coarse picture
    double speed_ = 0.0;      // samples per second, lately; 0: not known yet
    double seconds_ = 0.0;
    Clock::time_point moved_;
    Renderer renderer_;
};

}  // namespace glim
