// The kernels of a render, compiled for what the scene needs and the settings ask for.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/gpu/kernel.hpp"
#include "host/render/settings.hpp"

#include <optional>

namespace glim {

// The course's kernels (shaders/kernels/course). The production kernels know nothing of them.
struct CourseKernels {
    std::optional<Kernel> traceClosest, sampleLights, traceShadow, bounce;
    std::optional<Kernel> sampleHemisphere, traceHemisphere;  // of --direct hemisphere
    std::optional<Kernel> addLuminance, choosePixels;         // of --adaptive course
};

// Those of what a scene needs: kFeatureSpheres ...
Specialization makeConstants(FeatureMask features);

// The constants of the production kernels.
Specialization specialize(const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
                          const DeviceDescription& device);

// Whether kernels with the constants `compiled` do for those that are `needed`.
bool serves(const Specialization& compiled, Specialization needed);

// A kernel is absent if the settings do not need it.
struct KernelSet {
    // Compiles all kernels in parallel, for the chosen schedule.
    KernelSet(const KernelLayout& layout, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
              Schedule schedule);

    std::vector<const Kernel*> all() const;
    // The kernel that traces paths to their end, if there is one.
    const std::optional<Kernel>& ofPaths() const { return learnGuide ? learnGuide : tracePaths; }

    Specialization specialization;  // of the production kernels; that of the course's follows from it and the settings
    std::optional<Kernel> generateRays, accumulate;
    std::optional<Kernel> traceClosest, shadeSurface, traceShadow;  // of the wavefront
    std::optional<Kernel> tracePaths;                               // of the persistent schedule
    std::optional<Kernel> learnGuide;                               // in place of these
    std::optional<Kernel> traceLightPaths, addSplats;               // of caustics
    std::optional<Kernel> showAov;                                  // of AOVs other than radiance
    CourseKernels course;
};

// Kernels with the layout of their bindings. Renders of several scenes may share them.
struct CompiledKernels {
    CompiledKernels(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings, Schedule schedule);

    KernelLayout layout;
    KernelSet set;
};

}  // namespace glim
