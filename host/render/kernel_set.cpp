#include "host/render/kernel_set.hpp"

#include "host/flatten/large_triangles.hpp"
#include "host/gpu/replaced_kernels.hpp"
#include "host/render/course.hpp"
#include "host/render/parameters.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/course_types.h"

#include <algorithm>
#include <future>

namespace glim {
namespace {

// No kernel has a constant with this id.
constexpr std::uint32_t kSpecReplaced = 0xffffffff;

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
    return roulette == Roulette::Throughput ? kRouletteThroughput : roulette == Roulette::Fixed ? kRouletteFixed : kRouletteNone;
}

Specialization specializeCourse(Specialization constants, const RenderSettings& settings)
{
    constants[kSpecMollerTrumbore] = settings.course.intersector == Intersector::MollerTrumbore;
    constants[kSpecBruteForce] = settings.course.accelerator == Accelerator::None;
    constants[kSpecDirect] = directOf(settings.course.direct);
    constants[kSpecRoulette] = rouletteOf(settings.course.roulette);
    return constants;
}

}  // namespace

Specialization makeConstants(FeatureMask features)
{
    return {{kSpecFeatures, static_cast<std::uint32_t>(features)}, {kSpecUpperFeatures, static_cast<std::uint32_t>(features >> 32)}};
}

Specialization specialize(const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings, const DeviceDescription& device)
{
    Specialization constants =
        makeConstants(featuresSeenBy(scene, camera) & ~(tracesLight(scene, settings) ? 0U : kFeatureCaustics | kFeatureBrightEnvironment) &
                      ~(settings.catcher ? 0U : kFeatureCatcher) & ~(settings.lightGroups.empty() ? kFeatureLightGroups : 0U));
    constants[kSpecWorkgroup] = settings.workgroup;
    constants[kSpecStackLevels] = scene.stackLevels;
    const std::uint32_t viewBits = texelViewBits(device);
    constants[kSpecTexelViewBits] = viewBits;
    constants[kSpecTexelViews] = static_cast<std::uint32_t>((scene.images->texels.size() >> viewBits) + 1);
    constants[kSpecSobol] = settings.sampler == Sampler::Sobol;
    constants[kSpecLens] = camera.lensRight != vec3(0.0F);
    constants[kSpecMovingCamera] = camera.motion != 0;
    constants[kSpecProjection] = camera.projection.model;
    constants[kSpecChosen] = settings.adaptive != Adaptive::Off;
    constants[kSpecAov] = static_cast<std::uint32_t>(settings.aov);
    constants[kSpecSuspects] = settings.suspects > 0;
    constants[kSpecNotes] = settings.notes;
    constants[kSpecGuided] = settings.guide || settings.learns;
    constants[kSpecLearns] = settings.learns;
    constants[kSpecGuidedScatterings] = settings.guide && guideScatterings(settings.guide->texels);
    constants[kSpecPathsPerThread] = rulesOf(device.deviceClass).pathsPerThread;
    constexpr std::size_t kSharedBytes = 16384;  // that every device has
    const std::size_t stackBytes = 2 * sizeof(std::uint32_t) * scene.stackLevels * settings.workgroup;
    constants[kSpecSharedStack] = rulesOf(device.deviceClass).sharedStack && stackBytes <= kSharedBytes;
    if (const std::uint32_t version = replacedVersion(); version != 0) {
        constants[kSpecReplaced] = version;  // kernels of other shaders do not serve
    }
    return constants;
}

bool serves(const Specialization& compiled, Specialization needed)
{
    std::uint32_t& levels = needed[kSpecStackLevels];
    levels = std::max(levels, compiled.at(kSpecStackLevels));  // a deeper stack does as well
    return compiled == needed;
}

KernelSet::KernelSet(const KernelLayout& layout, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
                     Schedule schedule)
    : specialization(specialize(scene, camera, settings, layout.device().description()))
{
    const Specialization &production = specialization, ofCourse = specializeCourse(production, settings);
    std::vector<std::future<void>> compiling;
    const auto compile = [&](std::optional<Kernel>& kernel, const EmbeddedShader& shader, const Specialization& constants) {
        compiling.push_back(std::async(std::launch::async, [&] { kernel.emplace(layout, shader, constants); }));
    };
    if (usesCourseEstimators(settings)) {
        compile(course.sampleLights, kernels::course_sample_lights, ofCourse);  // takes the longest
        compile(course.bounce, kernels::course_bounce, ofCourse);
        compile(course.traceClosest, kernels::course_trace_closest, ofCourse);
        compile(course.traceShadow, kernels::course_trace_shadow, ofCourse);
        if (settings.course.direct == DirectLight::Hemisphere) {
            compile(course.sampleHemisphere, kernels::course_sample_hemisphere, ofCourse);
            compile(course.traceHemisphere, kernels::course_trace_hemisphere, ofCourse);
        }
    } else if (settings.learns) {
        compile(learnGuide, kernels::learn_guide, production);
    } else if (schedule == Schedule::Persistent) {
        compile(tracePaths, kernels::trace_paths, production);
    } else {
        compile(shadeSurface, kernels::shade_surface, production);
        compile(traceClosest, kernels::trace_closest, production);
        compile(traceShadow, kernels::trace_shadow, production);
    }
    if (tracesLight(scene, settings) && !settings.learns) {
        compile(traceLightPaths, kernels::trace_light_paths, production);
        compile(addSplats, kernels::add_splats, production);
    }
    compile(generateRays, kernels::generate_rays, production);
    compile(accumulate, kernels::accumulate, production);
    if (settings.aov != Aov::Radiance) {
        compile(showAov, kernels::show_aov, production);
    }
    if (isCourse(settings.adaptive)) {
        compile(course.addLuminance, kernels::course_add_luminance, ofCourse);
        compile(course.choosePixels, kernels::course_choose_pixels, ofCourse);
    }
    for (std::future<void>& kernel : compiling) {
        kernel.get();
    }
}

std::vector<const Kernel*> KernelSet::all() const
{
    std::vector<const Kernel*> kernels;
    for (const std::optional<Kernel>* kernel :
         {&generateRays, &traceClosest, &shadeSurface, &traceShadow, &tracePaths, &learnGuide, &traceLightPaths, &addSplats, &accumulate,
          &showAov, &course.traceClosest, &course.sampleLights, &course.traceShadow, &course.bounce, &course.sampleHemisphere,
          &course.traceHemisphere, &course.addLuminance, &course.choosePixels}) {
        if (*kernel) {
            kernels.push_back(&**kernel);
        }
    }
    return kernels;
}

CompiledKernels::CompiledKernels(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
                                 Schedule schedule)
    : layout(device, kernelSlots(), sizeof(CoursePass)),
      set(layout, scene, camera, settings, schedule)
{}

}  // namespace glim
