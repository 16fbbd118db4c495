#include "tests/support/kernel_test.hpp"

#include "host/render/path_buffers.hpp"
#include "places.h"
#include "shaders/shared/bindings.h"
#include "tests/support/report.h"
#include "tests/support/test_data.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

namespace glim {
namespace {

constexpr std::uint32_t kWorkgroup = 64;

std::string sourceOf(const EmbeddedShader& shader)
{
    return (testData("kernels", GLIM_SOURCE_DIR "/tests/kernels") / shader.name).string() + ".comp";
}

// The lines of the kernel's source that contain a check.
std::vector<std::uint32_t> checkedLines(const std::string& file)
{
    std::ifstream source(file);
    EXPECT_TRUE(source.good()) << "cannot read " << file;
    std::vector<std::uint32_t> lines;
    std::string text;
    for (std::uint32_t line = 1; std::getline(source, text); ++line) {
        if (text.find("EXPECT_") != std::string::npos && text.find("//") > text.find("EXPECT_")) {
            lines.push_back(line);
        }
    }
    return lines;
}

void addFailures(const std::string& file, const Report& report, std::uint32_t threads)
{
    for (std::uint32_t i = 0; i < std::min(report.failureCount, kMaxFailures); ++i) {
        const Failure& failure = report.failures[i];
        ADD_FAILURE_AT(file.c_str(), static_cast<int>(failure.line))
            << "case " << failure.thread << ": " << failure.actual << ", expected " << failure.expected << " within " << failure.tolerance
            << (i + 1 == kMaxFailures ? " (and more)" : "");
    }
    for (const std::uint32_t line : checkedLines(file)) {
        if ((report.lines[line / 32] >> line % 32 & 1U) == 0) {
            ADD_FAILURE_AT(file.c_str(), static_cast<int>(line)) << "this check never ran";
        }
    }
    EXPECT_EQ(report.threads, threads) << file << ": threads that ran to the end";
    EXPECT_NE(report.sentinel, kSentinel) << file << ": never ran";
}

KernelLayout makeLayout()
{
    std::vector<BindingSlot> slots = kernelSlots();
    for (const std::uint32_t binding : {kBindCases, kBindReport, kBindResults}) {
        slots.push_back({binding, BufferKind::Storage});
    }
    return {testDevice(), slots, sizeof(CoursePass)};
}

// Kept until the process ends: tests run the same kernel with many cases, and drivers take seconds to compile it.
const Kernel& compiled(const EmbeddedShader& shader, const Specialization& specialization)
{
    static const KernelLayout layout = makeLayout();
    static std::map<std::pair<std::string, Specialization>, Kernel> kernels;
    return kernels.try_emplace({shader.name, specialization}, layout, newest(shader), specialization).first->second;
}

}  // namespace

EmbeddedShader newest(const EmbeddedShader& shader)
{
    const char* folder = std::getenv("GLIM_TEST_KERNELS");
    if (folder == nullptr) {
        return shader;
    }
    static std::map<std::string, std::vector<std::uint32_t>> kept;
    std::vector<std::uint32_t>& words = kept[shader.name];
    if (words.empty()) {
        std::ifstream file(std::filesystem::path(folder) / (shader.name + std::string(".spv")), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        words.resize(bytes.size() / sizeof(std::uint32_t));
        std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t));
    }
    return words.empty() ? shader : EmbeddedShader{shader.name, words.data(), words.data() + words.size()};
}

void KernelTest::run()
{
    Device& device = testDevice();
    Buffer reportBuffer(device, "report", BufferKind::Storage, sizeof(Report));
    Report report{};
    report.sentinel = kSentinel;
    upload(reportBuffer, std::span<const Report>(&report, 1));

    const Buffer noChoice(device, "chosen pixels", BufferKind::Storage, 2 * sizeof(uint));
    Buffer status(device, "status", BufferKind::Storage, sizeof(Status));
    upload(status, std::span<const Status>(std::vector<Status>(1)));
    std::map<std::uint32_t, const Buffer*> bound = buffers_;
    bound.insert({{kBindChosenPixels, &noChoice}, {kBindStatus, &status}});
    bound[kBindReport] = &reportBuffer;
    if (cases_) {
        bound[kBindCases] = &*cases_;
    }
    if (results_) {
        bound[kBindResults] = &*results_;
    }
    parameters_.canarySteps = 3;
    specialization_.insert({kSpecWorkgroup, kWorkgroup});
    Buffer parameters(device, "test's parameters", BufferKind::Storage, sizeof(RenderParameters));
    upload(parameters, std::span<const RenderParameters>(&parameters_, 1));
    bound[kBindParameters] = &parameters;
    Buffer course(device, "test's parameters of the course", BufferKind::Storage, sizeof(CourseParameters));
    upload(course, std::span<const CourseParameters>(&course_, 1));
    bound[kBindCourseParameters] = &course;
    const Kernel& kernel = compiled(shader_, specialization_);
    const Bindings bindings(kernel.layout(), bound);
    const std::uint32_t groups = (push_.pass.pixelCount + kWorkgroup - 1) / kWorkgroup;
    Commands commands(device);
    commands.dispatch(kernel, bindings, std::as_bytes(std::span<const CoursePass, 1>(&push_, 1)), groups);
    commands.submitAndWait();
    report = download<Report>(reportBuffer, 1)[0];
    addFailures(sourceOf(shader_), report, groups * kWorkgroup);
    loopsSpent_ = report.loopsSpent;
    EXPECT_TRUE(loopsSpent_ == 0 || mayExhaustLoops_) << loopsSpent_ << " threads have spent their loop budget";
}

}  // namespace glim
