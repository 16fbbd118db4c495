#include "tests/support/irradiance.hpp"

#include "test_kernels.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/scene_on_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace glim {
namespace {

constexpr std::uint32_t kSamplesPerThread = 64;
constexpr std::size_t kFamily = 200;  // comparisons of irradiance in all tests

struct Case {
    vec3 point;
    float height;
    vec3 normal;
};

struct Result {
    float sum;
    float least, most;
    float pdf;
    float pdfError;
    uint compared;
    uint elsewhere;
    float surfaceError;
};

IrradianceEstimate reduce(std::span<const Result> results)
{
    IrradianceEstimate e{0, 0, 1e300, 0, 0, 0, 0, 0, 0};
    double squares = 0.0;
    for (const Result& r : results) {
        const double mean = static_cast<double>(r.sum) / kSamplesPerThread;
        e.mean += mean;
        squares += mean * mean;
        e.least = std::min(e.least, static_cast<double>(r.least));
        e.most = std::max(e.most, static_cast<double>(r.most));
        e.pdf = std::max(e.pdf, static_cast<double>(r.pdf));
        e.pdfError = std::max(e.pdfError, static_cast<double>(r.pdfError));
        e.compared += r.compared;
        e.elsewhere += r.elsewhere;
        e.surfaceError = std::max(e.surfaceError, static_cast<double>(r.surfaceError));
    }
    const auto n = static_cast<double>(results.size());
    e.mean /= n;
    e.standardError = std::sqrt(std::max(0.0, squares / n - e.mean * e.mean) / (n - 1.0));
    return e;
}

}  // namespace

std::vector<IrradianceEstimate> estimateIrradiance(const Scene& scene, const std::vector<Receiver>& receivers)
{
    const auto threads = static_cast<std::uint32_t>(hardTrials(samplesFor(2048, 20) * kSamplesPerThread)) / kSamplesPerThread;
    std::vector<Case> cases;
    for (const Receiver& receiver : receivers) {
        cases.push_back({receiver.point, receiver.height, receiver.normal});
    }
    const SceneOnDevice onDevice(scene);
    KernelTest test = onDevice.test(test_kernels::light_test);
    const std::size_t count = cases.size() * threads;
    test.cases(cases).resultsOf<Result>(count).threads(static_cast<std::uint32_t>(count));
    test.pass().sampleCount = threads;
    test.parameters().maxBounces = kSamplesPerThread;
    test.run();
    const std::vector<Result> results = test.results<Result>();
    std::vector<IrradianceEstimate> estimates;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        estimates.push_back(reduce(std::span(results).subspan(i * threads, threads)));
        EXPECT_LE(estimates.back().surfaceError, 1e-6 * (1.0 + static_cast<double>(glm::length(receivers[i].point))));
    }
    return estimates;
}

std::vector<IrradianceEstimate> expectIrradiance(const char* name, const Scene& scene, const std::vector<Receiver>& receivers,
                                                 double densityTolerance)
{
    const double limit = scoreLimit(kFamily);
    const std::vector<IrradianceEstimate> estimates = estimateIrradiance(scene, receivers);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const IrradianceEstimate& e = estimates[i];
        const double truth = receivers[i].truth;
        EXPECT_LE(std::abs(e.mean - truth), limit * e.standardError + 2e-5 * truth)
            << name << ", receiver " << i << ": " << e.mean << ", truth " << truth;
        EXPECT_LE(e.pdfError, densityTolerance) << name << ", receiver " << i;
        std::printf("%s %zu: %.6g, truth %.6g, z %.1f, sees %.1e; %zu densities within %.0e, %zu elsewhere\n", name, i, e.mean, truth,
                    e.standardError > 0.0 ? (e.mean - truth) / e.standardError : 0.0, truth > 0.0 ? limit * e.standardError / truth : 0.0,
                    e.compared, e.pdfError, e.elsewhere);
    }
    return estimates;
}

void expectExactIrradiance(const char* name, const Scene& scene, const std::vector<Receiver>& receivers)
{
    const std::vector<IrradianceEstimate> estimates = estimateIrradiance(scene, receivers);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const double truth = receivers[i].truth, slack = 0x1p-20 * truth;
        EXPECT_GE(estimates[i].least, truth - slack) << name << ", receiver " << i;
        EXPECT_LE(estimates[i].most, truth + slack) << name << ", receiver " << i;
    }
}

}  // namespace glim
