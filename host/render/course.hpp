// The estimators of the course (Berkeley's CS 184), beside the production path: their kernels, parameters and order.
#pragma once

#include "host/render/course_rounds.hpp"
#include "host/render/kernel_set.hpp"
#include "host/render/path_buffers.hpp"
#include "host/render/recording.hpp"
#include "shaders/shared/course_types.h"

namespace glim {

// Whether tracing needs the course's kernels. --adaptive course does not: it only chooses pixels.
bool usesCourseEstimators(const RenderSettings& settings);

// A bounce by the course's kernels:
//
//   course_trace_closest
//   per round of direct light:  course_sample_lights -> course_trace_shadow
//   course_bounce
//
// A round over the hemisphere has course_sample_hemisphere and course_trace_hemisphere instead. Brute force repeats each trace kernel for
// one range of references after another.
class CourseEstimators {
public:
    CourseEstimators(Device& device, const FlatScene& scene, const RenderSettings& settings);

    const Buffer& parameters() const { return parameters_; }

    void recordBounce(Recording& recording, const KernelSet& kernels, const Bindings& bindings, const Pass& pass,
                      const Buffer& passRounds) const;
    // course_trace_closest or course_trace_shadow alone, over the queue whose group counts are at groupsOffset in passRounds.
    void recordTrace(Recording& recording, const Kernel& kernel, const Bindings& bindings, CoursePass round, const Buffer& passRounds,
                     std::uint64_t groupsOffset) const;
    // Once no path is alive: updates the luminance statistics of --adaptive course.
    void recordLuminance(Recording& recording, const KernelSet& kernels, const Bindings& bindings, const Pass& pass,
                         std::uint32_t groups) const;

private:
    void recordRound(Recording& recording, const KernelSet& kernels, const Bindings& bindings, const CoursePass& round, bool hemisphere,
                     const Buffer& passRounds) const;

    RenderSettings settings_;
    std::uint32_t lightCount_;
    std::vector<LightRound> rounds_;  // of direct light at each hit
    std::uint32_t refCount_ = 0;
    Buffer parameters_;
};

}  // namespace glim
