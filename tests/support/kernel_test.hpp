// Runs a test kernel over an array of cases and turns what it reports into failures of the running test, each at the
// shader's own line.
#pragma once

#include "host/gpu/commands.hpp"
#include "shaders/shared/path_types.h"
#include "tests/support/test_device.hpp"

#include <optional>

namespace glim {

class KernelTest {
public:
    explicit KernelTest(const EmbeddedShader& shader) : shader_(shader) {}

    // What the kernel sees at kBindCases; sets the number of threads to the number of cases.
    template <class Case>
    KernelTest& cases(const std::vector<Case>& values)
    {
        cases_.emplace(testDevice(), "test cases", BufferKind::Storage, values.size() * sizeof(Case));
        upload(*cases_, std::span<const Case>(values));
        pass_.pixelCount = static_cast<std::uint32_t>(values.size());
        return *this;
    }
    // Room at kBindResults, zeroed; read it with results() after run().
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
    KernelTest& threads(std::uint32_t count)
    {
        pass_.pixelCount = count;
        return *this;
    }
    // Spending the driver's loop budget is no failure; loopsSpent() tells how many threads noticed.
    KernelTest& mayExhaustLoops()
    {
        mayExhaustLoops_ = true;
        return *this;
    }
    Pass& pass() { return pass_; }

    // Adds a failure to the running test for each failed check (the first kMaxFailures of them), for each check that never
    // ran, and for threads that never ended.
    void run();
    std::uint32_t loopsSpent() const { return loopsSpent_; }

    template <class Result>
    std::vector<Result> results() const
    {
        return download<Result>(*results_, results_->size() / sizeof(Result));
    }

private:
    EmbeddedShader shader_;
    Pass pass_{};
    std::optional<Buffer> cases_, results_;
    std::map<std::uint32_t, const Buffer*> buffers_;
    Specialization specialization_;
    bool mayExhaustLoops_ = false;
    std::uint32_t loopsSpent_ = 0;
};

}  // namespace glim
