#include "host/render/kernel_set.hpp"

#include "kernels.hpp"
#include "shaders/shared/bindings.h"

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
            {kSpecSmooth, features.smooth},
            {kSpecSpecular, features.specular},
            {kSpecSurfaceLights, features.surfaceLights},
            {kSpecPunctualLights, features.punctualLights},
            {kSpecEnvironment, features.environment},
            {kSpecSobol, settings.sampler == Sampler::Sobol},
            {kSpecMollerTrumbore, settings.intersector == Intersector::MollerTrumbore},
            {kSpecBruteForce, settings.accelerator == Accelerator::None},
            {kSpecDirect, directOf(settings.direct)},
            {kSpecRoulette, rouletteOf(settings.roulette)},
            {kSpecLens, camera.lensRight != vec3(0.0F)},
            {kSpecAdaptive, settings.adaptive != Adaptive::Off},
            {kSpecView, viewOf(settings.view)}};
}

KernelSet::KernelSet(const KernelLayout& layout, const Specialization& s)
    : generateRays(layout, kernels::generate_rays, s), sizeDispatch(layout, kernels::size_dispatch, s),
      traceClosest(layout, kernels::trace_closest, s), sampleLights(layout, kernels::sample_lights, s),
      traceShadow(layout, kernels::trace_shadow, s), bounce(layout, kernels::bounce, s),
      accumulate(layout, kernels::accumulate, s)
{
    if (s.at(kSpecDirect) == kDirectHemisphere) {
        sampleHemisphere.emplace(layout, kernels::sample_hemisphere, s);
        traceHemisphere.emplace(layout, kernels::trace_hemisphere, s);
    }
    if (s.at(kSpecView) != 0) {
        showView.emplace(layout, kernels::show_view, s);
    }
    if (s.at(kSpecAdaptive) != 0) {
        choosePixels.emplace(layout, kernels::choose_pixels, s);
    }
}

std::vector<const Kernel*> KernelSet::all() const
{
    std::vector<const Kernel*> kernels = {&sizeDispatch, &generateRays, &traceClosest, &sampleLights,
                                          &traceShadow,  &bounce,       &accumulate};
    for (const std::optional<Kernel>* optional : {&sampleHemisphere, &traceHemisphere, &showView, &choosePixels}) {
        if (*optional) {
            kernels.push_back(&**optional);
        }
    }
    return kernels;
}

}  // namespace glim
