// Whether light paths or camera paths are to find a scene's caustics: an estimate of the variance of both, by a small picture.
#pragma once

#include "host/render/renderer.hpp"

namespace glim {

// The variance of a sample over the square of the radiance around its pixel, averaged over the picture.
struct LightPathGain {
    double rest = 0.0;    // of camera paths that leave caustics to light paths
    double light = 0.0;   // of light paths
    double camera = 0.0;  // of camera paths that find the same caustics
    double work = 0.0;    // rays of light paths over those of camera paths

    // Whether light paths have the smaller product of variance and rays.
    bool isGain() const { return (rest + light) * (1.0 + work) < rest + camera; }
};

// Of a scene and settings that tracesLight() is true of. The same on all devices whose pictures have the same bits, and for all samples,
// seeds and rows of a picture. Shares the resources of `renderer`, a renderer of the scene.
LightPathGain measureLightPaths(const Renderer& renderer, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

// Whether the settings leave caustics to light paths, if that pays: some caustics have no other. `makeRenderer` returns one of the scene
// for measureLightPaths.
bool choosesLightPaths(const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
                       const std::function<const Renderer&()>& makeRenderer);
// The same, with a renderer of its own.
bool choosesLightPaths(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

}  // namespace glim
