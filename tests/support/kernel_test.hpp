// Runs a test kernel with the push constants and the bindings of glim's kernels.
#pragma once

#include "host/render/kernel_set.hpp"
#include "shaders/shared/course_types.h"
#include "tests/harness/kernel_run.hpp"

namespace glim {

class KernelTest : public KernelRun {
public:
    explicit KernelTest(const EmbeddedShader& shader);

    KernelTest& features(FeatureMask features)
    {
        for (const auto& [id, value] : makeConstants(features)) {
            specialize(id, value);
        }
        return *this;
    }
    Pass& pass() { return push_.pass; }
    CourseRound& lightRound() { return push_.lightRound; }
    CourseParameters& course() { return course_; }
    RenderParameters& parameters() { return parameters_; }

    void run() override;

private:
    CoursePass push_{};
    CourseParameters course_{};
    RenderParameters parameters_{};
};

}  // namespace glim
