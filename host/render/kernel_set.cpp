#include "host/render/kernel_set.hpp"

#include "kernels.hpp"
#include "shaders/shared/bindings.h"

#include <future>

namespace glim {
namespace {

std::uint32_t directOf(DirectLight direct)
{
    switch (direct) {
    case DirectLight::Mis: return kDirectMis;
    case DirectLight::Lights: return kDirectLights;
    case DirectLight::Hemisphere: return kDirectHemisphere;
    case DirectLight::Bsdf: break;
    }
    return kDirectBsdf;
}

std::uint32_t rouletteOf(Roulette roulette)
{
    return roulette == Roulette::Throughput ? kRouletteThroughput
           : roulette == Roulette::Fixed    ? kRouletteFixed
                                            : kRouletteNone;
}

// 0: shaded, which needs no kernel.
std::uint32_t viewOf(View view)
{
    switch (view) {
    case View::Shaded: break;
    case View::Normal: return kViewNormal;
    case View::Depth: return kViewDepth;
    case View::Albedo: return kViewAlbedo;
    case View::BvhSteps: return kViewBvhSteps;
    }
    return 0;
}

}  // namespace

Specialization specialize(const SceneFeatures& features, const FlatCamera& camera, const RenderSettings& settings)
{
    return {{kSpecWorkgroup, settings.workgroup},
            {kSpecSpheres, features.spheres},
            {kSpecSlivers, features.slivers},
            {kSpecSmooth, features.smooth},
            {kSpecMirrors, features.mirrors},
            {kSpecGlasses, features.glasses},
            {kSpecTriangleLights, features.triangleLights},
            {kSpecSphereLights, features.sphereLights},
            {kSpecPunctualLights, features.punctualLights},
            {kSpecEnvironment, features.environment},
            {kSpecStackLevels, features.stackLevels},
            {kSpecSobol, settings.sampler == Sampler::Sobol},
            {kSpecMollerTrumbore, settings.intersector == Intersector::MollerTrumbore},
            {kSpecBruteForce, settings.accelerator == Accelerator::None},
            {kSpecDirect, directOf(settings.direct)},
            {kSpecRoulette, rouletteOf(settings.roulette)},
            {kSpecLens, camera.lensRight != vec3(0.0F)},
            {kSpecChosen, settings.adaptive != Adaptive::Off},
            {kSpecView, viewOf(settings.view)},
            {kSpecSuspects, settings.suspects > 0},
            {kSpecNotes, settings.notes},
            {kSpecLuminance, isCourse(settings.adaptive)}};
}

KernelSet::KernelSet(const KernelLayout& layout, const Specialization& s, Schedule schedule)
{
    std::vector<std::future<void>> compiling;
    const auto compile = [&](std::optional<Kernel>& kernel, const EmbeddedShader& shader) {
        compiling.push_back(std::async(std::launch::async, [&] { kernel.emplace(layout, shader, s); }));
    };
    if (schedule == Schedule::Persistent) {
        compile(tracePaths, kernels::trace_paths);
    } else {
        compile(sampleLights, kernels::sample_lights);  // the longest
        compile(bounce, kernels::bounce);
        compile(traceClosest, kernels::trace_closest);
        compile(traceShadow, kernels::trace_shadow);
    }
    compile(generateRays, kernels::generate_rays);
    compile(accumulate, kernels::accumulate);
    compile(sizeDispatch, kernels::size_dispatch);
    if (s.at(kSpecDirect) == kDirectHemisphere) {
        compile(sampleHemisphere, kernels::sample_hemisphere);
        compile(traceHemisphere, kernels::trace_hemisphere);
    }
    if (s.at(kSpecView) != 0) {
        compile(showView, kernels::show_view);
    }
    if (s.at(kSpecLuminance) != 0) {
        compile(choosePixels, kernels::choose_pixels);
    }
    for (std::future<void>& kernel : compiling) {
        kernel.get();
    }
}

std::vector<const Kernel*> KernelSet::all() const
{
    std::vector<const Kernel*> kernels;
    for (const std::optional<Kernel>* kernel : {&sizeDispatch, &generateRays, &traceClosest, &sampleLights, &traceShadow, &bounce,
                                                &tracePaths, &accumulate, &sampleHemisphere, &traceHemisphere, &showView, &choosePixels}) {
        if (*kernel) {
            kernels.push_back(&**kernel);
        }
    }
    return kernels;
}

}  // namespace glim
