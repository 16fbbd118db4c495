// Runs a test kernel over an array of cases. Each failed check of the kernel becomes a failure of the running test, at the line of the
// shader.
#pragma once

#include "host/gpu/commands.hpp"
#include "host/render/kernel_set.hpp"
#include "shaders/shared/course_types.h"
#include "tests/support/test_device.hpp"

#include <optional>

namespace glim {

// The kernel as tools/test --watch has just compiled it, which saves linking the program; without that, as it is part of the program.
EmbeddedShader newest(const EmbeddedShader& shader);

class KernelTest {
public:
    explicit KernelTest(const EmbeddedShader& shader)
        : shader_(shader)
    {}

    // Binds the cases at kBindCases and runs one thread per case.
    template <class Case>
    KernelTest& cases(const std::vector<Case>& values)
    {
        cases_.emplace(testDevice(), "test cases", BufferKind::Storage, values.size() * sizeof(Case));
        upload(*cases_, std::span<const Case>(values));
        push_.pass.pixelCount = static_cast<std::uint32_t>(values.size());
        return *this;
    }
    // Binds room for results at kBindResults, filled with zeros. results() reads it after run().
    template <class Result>
    KernelTest& resultsOf(std::size_t count)
    {
        results_.emplace(testDevice(), "test results", BufferKind::Storage, count * sizeof(Result));
        upload(*results_, std::span<const Result>(std::vector<Result>(count)));
        return *this;
    }
    KernelTest& buffers(const std::map<std::uint32_t, const Buffer*>& more)
    {
        buffers_.insert(more.begin(), more.end());
        return *this;
    }
    KernelTest& specialize(std::uint32_t id, std::uint32_t value)
    {
        specialization_[id] = value;
        return *this;
    }
    KernelTest& features(FeatureMask features)
    {
        for (const auto& [id, value] : makeConstants(features)) {
            specialization_[id] = value;
        }
        return *this;
    }
    KernelTest& threads(std::uint32_t count)
    {
        push_.pass.pixelCount = count;
        return *this;
    }
    // A spent loop budget of the driver is no failure. loopsSpent() tells how many threads noticed one.
    KernelTest& mayExhaustLoops()
    {
        mayExhaustLoops_ = true;
        return *this;
    }
    Pass& pass() { return push_.pass; }
    CourseRound& lightRound() { return push_.lightRound; }
    CourseParameters& course() { return course_; }
    RenderParameters& parameters() { return parameters_; }

    // Adds a failure to the running test for each failed check (at most kMaxFailures), for each check that never ran, and if a thread
    // has not reached its end.
    void run();
    std::uint32_t loopsSpent() const { return loopsSpent_; }

    template <class Result>
    std::vector<Result> results() const
    {
        return download<Result>(*results_, results_->size() / sizeof(Result));
    }

private:
    EmbeddedShader shader_;
    CoursePass push_{};
    CourseParameters course_{};
    RenderParameters parameters_{};
    std::optional<Buffer> cases_, results_;
    std::map<std::uint32_t, const Buffer*> buffers_;
    Specialization specialization_;
    bool mayExhaustLoops_ = false;
    std::uint32_t loopsSpent_ = 0;
};

}  // namespace glim
