// A driver that fails: one sentence, exit code 3, and the last checkpoint stays.
#include "host/render/film_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace glim::test {
namespace {

class DeviceFaultTest : public ::testing::Test {
protected:
    GlimCall call() const
    {
        GlimCall call;
        call.arguments = {"render",       sceneFile("cornell.gltf"),
                          "--size",       "16x16",
                          "--spp",        "400",
                          "--checkpoint", "0.001s",
                          "--resume",     "--progress",
                          "none",         "-o",
                          film_.string()};
        return call;
    }
    GlimRun runWith(const std::string& variable, const std::string& value) const
    {
        GlimCall faulty = call();
        faulty.environment["LD_PRELOAD"] = GLIM_FAIL_IN_VULKAN;
        faulty.environment[variable] = value;
        return runForMessages(faulty);
    }
    // Besides, something may be on stdout: what was finished before.
    static void expectFault(const GlimRun& run, MessageId id, const Parts& parts)
    {
        EXPECT_EQ(run.exitCode, 3) << run.err;
        EXPECT_EQ(countLines(run.err), 1U) << run.err;
        expectSaid(run, id, parts);
    }

    ScratchFolder folder_;
    std::filesystem::path film_ = folder_ / "film.exr";
};

TEST_F(DeviceFaultTest, ALostDeviceLeavesTheLastCheckpoint)
{
    ASSERT_EQ(runGlim(call()).exitCode, 0);
    const std::string expected = computeDigest(readFilm(film_));
    int faults = 0, checkpoints = 0;
    for (int at = 1;; at += 1 + at / 3) {
        std::filesystem::remove(film_);
        const GlimRun run = runWith("GLIM_LOSE_DEVICE_AT", std::to_string(at));
        if (run.exitCode == 0) {
            break;
        }
        ++faults;
        const bool kept = std::filesystem::exists(film_);
        expectFault(run, MessageId::DriverFailed, {.file = kept ? film_.string() : "", .value = "VK_ERROR_DEVICE_LOST"});
        checkpoints += kept ? 1 : 0;
        EXPECT_EQ(folder_.entries(), kept ? 1 : 0);
        EXPECT_EQ(run.err.find("has the last checkpoint") != std::string::npos, kept) << run.err;
        EXPECT_EQ(runGlim(call()).exitCode, 0);
        EXPECT_EQ(computeDigest(readFilm(film_)), expected) << at;
    }
    EXPECT_GT(faults, 5);
    EXPECT_GT(checkpoints, 0);
}

TEST_F(DeviceFaultTest, ADeviceThatIsLostAfterTheRenderLeavesTheFilm)
{
    GlimCall denoised;
    denoised.arguments = {"render", sceneFile("cornell.gltf"), "--size", "16x16", "--spp", "64", "--denoise", "-o", film_.string()};
    ASSERT_EQ(runGlim(denoised).exitCode, 0);
    const std::string expected = computeDigest(readFilm(film_));
    denoised.environment["LD_PRELOAD"] = GLIM_FAIL_IN_VULKAN;
    int kept = 0;
    for (int at = 1;; at += 1 + at / 2) {
        std::filesystem::remove(film_);
        denoised.environment["GLIM_LOSE_DEVICE_AT"] = std::to_string(at);
        const GlimRun run = runForMessages(denoised);
        if (run.exitCode == 0) {
            break;
        }
        expectFault(run, MessageId::DriverFailed, {.value = "VK_ERROR_DEVICE_LOST"});
        if (std::filesystem::exists(film_)) {
            ++kept;
            EXPECT_EQ(computeDigest(readFilm(film_)), expected);
            EXPECT_NE(run.out.find("64 samples per pixel"), std::string::npos) << run.out;
        }
    }
    EXPECT_GT(kept, 0);
}

TEST_F(DeviceFaultTest, MemoryThatIsRefusedIsNamed)
{
    int faults = 0;
    for (int at = 1;; at += 3) {
        const GlimRun run = runWith("GLIM_REFUSE_MEMORY_AT", std::to_string(at));
        if (run.exitCode == 0) {
            break;
        }
        ++faults;
        expectFault(run, MessageId::OutOfMemory, {.expected = " MiB"});
        EXPECT_EQ(folder_.entries(), 0);
    }
    EXPECT_GT(faults, 5);
}

// The validation layers print a line for each object that is left when the device goes.
TEST_F(DeviceFaultTest, WhatCannotBeMadeLeavesNothingBehind)
{
    GlimCall faulty = call();
    faulty.environment["LD_PRELOAD"] = GLIM_FAIL_IN_VULKAN;
    faulty.environment["GLIM_VALIDATION"] = "1";
    int faults = 0;
    for (int at = 1;; at += 1 + at / 8) {
        std::filesystem::remove(film_);
        faulty.environment["GLIM_REFUSE_OBJECTS_AT"] = std::to_string(at);
        const GlimRun run = runForMessages(faulty);
        if (run.exitCode == 0) {
            break;
        }
        ++faults;
        expectFault(run, MessageId::OutOfMemory, {.value = "VK_ERROR_OUT_OF_HOST_MEMORY"});
    }
    EXPECT_GT(faults, 20);
}

TEST_F(DeviceFaultTest, ADriverWithoutWhatGlimNeedsIsNotUsed)
{
    const GlimRun run = runWith("GLIM_LACK_FEATURES", "1");
    expectFault(run, MessageId::DeviceMissing, {});
    EXPECT_TRUE(contains(run.err, "which lacks scalarBlockLayout")) << run.err;
    EXPECT_EQ(folder_.entries(), 0);
}

}  // namespace
}  // namespace glim::test
