// Runs a test kernel over an array of cases. Each failed check of the kernel becomes a failure of the running test, at the line of the
// shader.
#pragma once

#include "host/gpu/kernel.hpp"
#include "tests/harness/guarded_buffer.hpp"
#include "tests/harness/interface.h"
#include "tests/harness/test_device.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <vector>

namespace glim {

// The kernel as tools/test --watch has just compiled it, which saves linking the program; without that, as it is part of the program.
EmbeddedShader newest(const EmbeddedShader& shader);

// A kernel that includes kernel_test.glsl. Kernels with push constants and buffers of their own have a class that derives from this one.
class KernelRun {
public:
    // `folder` has the kernel's source, which is read for the lines of its checks.
    KernelRun(const EmbeddedShader& shader, const std::filesystem::path& folder);
    KernelRun(KernelRun&&) = default;
    virtual ~KernelRun() = default;

    // Binds the cases at kBindCases and runs one thread per case.
    template <class Case>
    KernelRun& cases(const std::vector<Case>& values)
    {
        cases_.emplace(testDevice(), "test cases", std::as_bytes(std::span<const Case>(values)));
        return threads(static_cast<std::uint32_t>(values.size()));
    }
    // Binds room for results at kBindResults, filled with zeros. results() reads it after run().
    template <class Result>
    KernelRun& resultsOf(std::size_t count)
    {
        results_.emplace(testDevice(), "test results", std::as_bytes(std::span<const Result>(std::vector<Result>(count))));
        return *this;
    }
    KernelRun& buffers(const std::map<std::uint32_t, const Buffer*>& more)
    {
        buffers_.insert(more.begin(), more.end());
        return *this;
    }
    KernelRun& specialize(std::uint32_t id, std::uint32_t value)
    {
        specialization_[id] = value;
        return *this;
    }
    KernelRun& threads(std::uint32_t count)
    {
        push_.count = count;
        return *this;
    }
    KernelRun& seed(std::uint32_t seed)
    {
        push_.seed = seed;
        return *this;
    }
    // A spent loop budget of the driver is no failure. loopsSpent() tells how many threads noticed one.
    KernelRun& mayExhaustLoops()
    {
        mayExhaustLoops_ = true;
        return *this;
    }

    // Adds a failure to the running test for each failed check (at most kMaxFailures), for each check that never ran, if a thread has not
    // reached its end, and if one has written beyond the cases or the results.
    virtual void run();
    std::uint32_t loopsSpent() const { return loopsSpent_; }

    template <class Result>
    std::vector<Result> results() const
    {
        return download<Result>(results_->buffer(), results_->size() / sizeof(Result));
    }

protected:
    // The layout has the three bindings of tests, and the kernel workgroups of kTestWorkgroup. `usual` is bound where buffers() has
    // nothing.
    void runWith(const KernelLayout& layout, std::span<const std::byte> push, const std::map<std::uint32_t, const Buffer*>& usual = {});
    std::uint32_t threadCount() const { return push_.count; }

private:
    void checkReport(const Report& report);
    void checkGuard(const std::optional<GuardedBuffer>& buffer, const std::string& what, const std::string& binding) const;

    EmbeddedShader shader_;
    std::string source_;
    TestPush push_{0, 0, 3};
    std::optional<GuardedBuffer> cases_, results_;
    std::map<std::uint32_t, const Buffer*> buffers_;
    Specialization specialization_;
    bool mayExhaustLoops_ = false;
    std::uint32_t loopsSpent_ = 0;
};

}  // namespace glim
