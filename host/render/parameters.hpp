// The parameters that kernels get once per render.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/gpu/buffer.hpp"
#include "host/render/settings.hpp"
#include "shaders/shared/path_types.h"

namespace glim {

// Light counts if `min` to `max` surfaces are between it and the camera. A path meets at most maxBounces surfaces before its last one.
struct PathLengths {
    std::uint32_t min, max, maxBounces;
};
PathLengths pathLengths(const RenderSettings& settings);

// Whether caustics are left to light paths: in scenes with kFeatureCaustics, unless the settings say otherwise. The course has its own
// estimators and its own rule of when a pixel is done, both of camera paths.
bool tracesLight(const FlatScene& scene, const RenderSettings& settings);

// Whether a film can keep the light of the scene's groups of lights (RenderSettings::lightGroups): as above.
bool keepsGroups(const FlatScene& scene, const RenderSettings& settings);

// Whether a film can keep what the scene's shadow catchers show (RenderSettings::catcher): not of the course's estimators, nor of AOVs.
bool catches(const FlatScene& scene, const RenderSettings& settings);
// These settings, with shadow catchers if the scene has any. Its film is not denoised then, and needs no halves.
RenderSettings catchingSettings(const FlatScene& scene, RenderSettings settings);

// Units of a splat per W/(sr m^2). A pixel holds 2^32 times the radiance that the scene's brightest light gives a white surface, in steps
// of 2^-32 of it.
float splatScale(const FlatScene& scene);

class DeviceParameters {
public:
    // `time`: of all paths, as in FlatMotionKey; without one they have their own, while the shutter is open.
    DeviceParameters(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
                     std::optional<float> time = std::nullopt);

    // No kernel may be running.
    void setCamera(const FlatCamera& camera, std::uint32_t width, std::uint32_t height);
    void setSeed(std::uint32_t seed);

    const Buffer& buffer() const { return buffer_; }

private:
    RenderParameters parameters_{};
    Buffer buffer_;
};

}  // namespace glim
