#include "host/render/course.hpp"

#include "host/render/parameters.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <cstddef>

namespace glim {

bool usesCourseEstimators(const RenderSettings& settings)
{
    return settings.course.direct != DirectLight::Mis || settings.course.roulette != Roulette::Throughput ||
           settings.course.accelerator != Accelerator::Bvh || settings.course.intersector != Intersector::Watertight;
}

CourseEstimators::CourseEstimators(Device& device, const FlatScene& scene, const RenderSettings& settings)
    : settings_(settings),
      lightCount_(static_cast<std::uint32_t>(scene.lights.size())),
      rounds_(lightRounds(scene, settings)),
      parameters_(device, "course's parameters", BufferKind::Storage, sizeof(CourseParameters))
{
    CourseParameters parameters{};
    parameters.refCount = refCount_ = static_cast<std::uint32_t>(scene.primitiveRefs.size()) / kPrimitiveRefTexels;
    parameters.continuation = settings.course.survival;
    parameters.tolerance = settings.course.tolerance;
    parameters.constantSamples = settings.adaptive == Adaptive::CourseLiteral ? 0 : kConstantSamples;
    upload(parameters_, std::span<const CourseParameters>(&parameters, 1));
}

void CourseEstimators::recordBounce(Recording& recording, const KernelSet& kernels, const Bindings& bindings, const Pass& pass,
                                    const Buffer& passRounds) const
{
    recordTrace(recording, *kernels.course.traceClosest, bindings, {pass, {}}, passRounds, groupsOfPaths(pass.round));
    const PathLengths lengths = pathLengths(settings_);
    const std::vector<LightRound> finding = {{false, kNoLightIndex}};
    CoursePass round{pass, {}};
    round.lightRound.addsEmission = 1;
    for (const LightRound& each : samplesLights(pass.bounce, lengths.maxBounces, lengths.min, lightCount_) ? rounds_ : finding) {
        round.lightRound.light = each.light;
        round.lightRound.lightSample = each.sample;
        round.lightRound.lightSamples = each.samples;
        recordRound(recording, kernels, bindings, round, each.hemisphere, passRounds);
        round.lightRound.addsEmission = 0;
    }
    recording.dispatchIndirect(*kernels.course.bounce, bindings, CoursePass{pass, {}}, passRounds, groupsOfPaths(pass.round));
}

void CourseEstimators::recordRound(Recording& recording, const KernelSet& kernels, const Bindings& bindings, const CoursePass& round,
                                   bool hemisphere, const Buffer& passRounds) const
{
    const Kernel& sample = hemisphere ? *kernels.course.sampleHemisphere : *kernels.course.sampleLights;
    const bool traces = hemisphere || round.lightRound.light != kNoLightIndex;
    if (traces) {  // the shadow rays of the round of direct light before are done
        const Queue empty = makeRounds(0, 0)[0].shadowRays;
        recording.write(passRounds, round.pass.round * sizeof(Round) + offsetof(Round, shadowRays), std::span<const Queue>(&empty, 1));
    }
    recording.dispatchIndirect(sample, bindings, round, passRounds, groupsOfPaths(round.pass.round));
    if (traces) {
        recordTrace(recording, hemisphere ? *kernels.course.traceHemisphere : *kernels.course.traceShadow, bindings, round, passRounds,
                    groupsOfShadowRays(round.pass.round));
    }
}

void CourseEstimators::recordTrace(Recording& recording, const Kernel& kernel, const Bindings& bindings, CoursePass round,
                                   const Buffer& passRounds, std::uint64_t groupsOffset) const
{
    const bool bruteForce = settings_.course.accelerator == Accelerator::None;
    const std::uint32_t step = bruteForce ? kScanPrimitiveRefs : refCount_;
    for (round.lightRound.firstRef = 0; round.lightRound.firstRef < refCount_; round.lightRound.firstRef += step) {
        round.lightRound.endRef = std::min(refCount_, round.lightRound.firstRef + step);
        recording.dispatchIndirect(kernel, bindings, round, passRounds, groupsOffset);
    }
}

void CourseEstimators::recordLuminance(Recording& recording, const KernelSet& kernels, const Bindings& bindings, const Pass& pass,
                                       std::uint32_t groups) const
{
    if (kernels.course.addLuminance) {
        recording.dispatch(*kernels.course.addLuminance, bindings, CoursePass{pass, {}}, groups);
    }
}

}  // namespace glim
