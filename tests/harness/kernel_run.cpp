#include "tests/harness/kernel_run.hpp"

#include "host/gpu/commands.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <tuple>

namespace glim {
namespace {

std::vector<std::string> readLines(const std::string& file)
{
    std::ifstream source(file);
    EXPECT_TRUE(source.good()) << "cannot read " << file;
    std::vector<std::string> lines;
    for (std::string line; std::getline(source, line);) {
        lines.push_back(line.substr(0, line.find("//")));
    }
    return lines;
}

// The lines of the kernel's source that contain a word, the first being 1.
std::vector<std::uint32_t> linesWith(const std::string& word, const std::string& file)
{
    std::vector<std::uint32_t> found;
    std::uint32_t number = 0;
    for (const std::string& line : readLines(file)) {
        ++number;
        if (line.find(word) != std::string::npos) {
            found.push_back(number);
        }
    }
    return found;
}

// Kept until the process ends, as are the kernels that have it.
const KernelLayout& layoutOf(const std::map<std::uint32_t, BufferKind>& kinds)
{
    Device& device = testDevice();
    static std::map<std::map<std::uint32_t, BufferKind>, KernelLayout> layouts;
    std::vector<BindingSlot> slots;
    for (const auto& [binding, kind] : kinds) {
        slots.push_back({binding, kind});
    }
    return layouts.try_emplace(kinds, device, slots, static_cast<std::uint32_t>(sizeof(TestPush))).first->second;
}

// Kept until the process ends: tests run the same kernel with many cases, and drivers take seconds to compile it.
const Kernel& compiled(const KernelLayout& layout, const EmbeddedShader& shader, const Specialization& specialization)
{
    static std::map<std::tuple<const KernelLayout*, std::string, Specialization>, Kernel> kernels;
    return kernels.try_emplace({&layout, shader.name, specialization}, layout, newest(shader), specialization).first->second;
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

KernelRun::KernelRun(const EmbeddedShader& shader, const std::filesystem::path& folder)
    : shader_(shader),
      source_((folder / shader.name).string() + ".comp")
{}

void KernelRun::run()
{
    std::map<std::uint32_t, BufferKind> kinds;
    for (const auto& [binding, buffer] : buffers_) {
        kinds[binding] = buffer->kind();
    }
    for (const std::uint32_t binding : {kBindCases, kBindReport, kBindResults}) {
        kinds[binding] = BufferKind::Storage;
    }
    runWith(layoutOf(kinds), std::as_bytes(std::span<const TestPush, 1>(&push_, 1)));
}

void KernelRun::runWith(const KernelLayout& layout, std::span<const std::byte> push, const std::map<std::uint32_t, const Buffer*>& usual)
{
    Device& device = testDevice();
    Buffer reportBuffer(device, "report", BufferKind::Storage, sizeof(Report));
    Report report{};
    report.sentinel = kSentinel;
    upload(reportBuffer, std::span<const Report>(&report, 1));

    std::map<std::uint32_t, const Buffer*> bound = buffers_;
    bound.insert(usual.begin(), usual.end());
    bound[kBindReport] = &reportBuffer;
    if (cases_) {
        bound[kBindCases] = &cases_->buffer();
    }
    if (results_) {
        bound[kBindResults] = &results_->buffer();
    }
    const Kernel& kernel = compiled(layout, shader_, specialization_);
    const Bindings bindings(layout, bound);
    Commands commands(device);
    commands.dispatch(kernel, bindings, push, (push_.count + kTestWorkgroup - 1) / kTestWorkgroup);
    commands.submitAndWait();
    checkReport(download<Report>(reportBuffer, 1)[0]);
    checkGuard(cases_, "cases", "kBindCases");
    checkGuard(results_, "results", "kBindResults");
}

void KernelRun::checkReport(const Report& report)
{
    for (std::uint32_t i = 0; i < std::min(report.failureCount, kMaxFailures); ++i) {
        const Failure& failure = report.failures[i];
        ADD_FAILURE_AT(source_.c_str(), static_cast<int>(failure.line))
            << "case " << failure.thread << ": " << failure.actual << ", expected " << failure.expected << " within " << failure.tolerance
            << (i + 1 == kMaxFailures ? " (and more)" : "");
    }
    for (const std::uint32_t line : linesWith("EXPECT_", source_)) {
        if ((report.lines[line / 32] >> line % 32 & 1U) == 0) {
            ADD_FAILURE_AT(source_.c_str(), static_cast<int>(line)) << "this check never ran";
        }
    }
    const std::uint32_t started = (push_.count + kTestWorkgroup - 1) / kTestWorkgroup * kTestWorkgroup;
    EXPECT_EQ(report.threads, started) << source_ << ": threads that ran to the end";
    EXPECT_NE(report.sentinel, kSentinel) << source_ << ": never ran";
    loopsSpent_ = report.loopsSpent;
    EXPECT_TRUE(loopsSpent_ == 0 || mayExhaustLoops_) << loopsSpent_ << " threads have spent their loop budget";
}

// The failure is at the line that declares the buffer.
void KernelRun::checkGuard(const std::optional<GuardedBuffer>& buffer, const std::string& what, const std::string& binding) const
{
    const std::optional<std::uint64_t> byte = buffer ? buffer->firstOverwritten() : std::nullopt;
    if (byte) {
        const std::vector<std::uint32_t> lines = linesWith(binding, source_);
        ADD_FAILURE_AT(source_.c_str(), lines.empty() ? 1 : static_cast<int>(lines[0]))
            << "the kernel has written beyond the " << what << ": " << *byte << " bytes behind their end";
    }
}

}  // namespace glim
