// The kernels of a render, compiled for what the scene needs and the settings ask for.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/gpu/kernel.hpp"
#include "host/render/settings.hpp"

#include <optional>

namespace glim {

Specialization specialize(const SceneFeatures& features, const FlatCamera& camera, const RenderSettings& settings);

// Absent where no picture of these settings needs it.
struct KernelSet {
    // Compiles all at the same time.
    KernelSet(const KernelLayout& layout, const Specialization& specialization, Schedule schedule);

    std::vector<const Kernel*> all() const;

    std::optional<Kernel> generateRays, sizeDispatch, accumulate;
    std::optional<Kernel> traceClosest, sampleLights, traceShadow, bounce;  // of the wavefront
    std::optional<Kernel> tracePaths;                                       // of the persistent schedule
    std::optional<Kernel> sampleHemisphere, traceHemisphere;                // of --direct hemisphere
    std::optional<Kernel> showView;                                         // of views other than shaded
    std::optional<Kernel> choosePixels;                                     // of --adaptive course
};

}  // namespace glim
