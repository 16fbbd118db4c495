// --checkpoint and --resume: whatever ends a render, the same command goes on with the bits of one run.
#include "host/atomic_file.hpp"
#include "host/image/exr.hpp"
#include "host/render/film_file.hpp"
#include "shaders/shared/limits.h"
#include "tests/support/expect_message.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/simulated_film.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <csignal>

namespace glim::test {
namespace {

class CommandLineResumeTest : public ::testing::Test {
protected:
    GlimCall call(std::vector<std::string> arguments) const
    {
        GlimCall call;
        call.arguments = {"render", sceneFile("cornell.gltf"), "-o", film_.string()};
        call.arguments.insert(call.arguments.end(), arguments.begin(), arguments.end());
        if (std::ranges::find(arguments, "--size") == arguments.end()) {
            call.arguments.insert(call.arguments.end(), {"--size", "12x12"});
        }
        call.folder = folder_.path();
        return call;
    }
    // Fails the n-th call that writes.
    static GlimCall failing(GlimCall call, int at, const char* how, const std::filesystem::path& folder)
    {
        call.environment["LD_PRELOAD"] = GLIM_FAIL_AT_CALL;
        call.environment["GLIM_FAIL_FOLDER"] = folder.string();
        call.environment["GLIM_FAIL_AT"] = std::to_string(at);
        call.environment["GLIM_FAIL_HOW"] = how;
        return call;
    }
    void expectDone(const std::vector<std::string>& arguments) const
    {
        const GlimRun run = runGlim(call(arguments));
        EXPECT_EQ(run.exitCode, 0) << run.err;
    }
    void expectRefused(const std::vector<std::string>& arguments, MessageId id, Parts parts = {}) const
    {
        const std::string before = readFileBytes(film_);
        parts.file = parts.file.empty() ? film_.string() : parts.file;
        test::expectRefused(runForMessages(call(arguments)), 1, id, parts);
        EXPECT_EQ(readFileBytes(film_), before);
    }
    std::string digestOfOneRun(const std::string& samples)
    {
        expectDone({"--spp", samples});
        const std::string digest = computeDigest(readFilm(film_));
        std::filesystem::remove(film_);
        return digest;
    }

    ScratchFolder folder_;
    std::filesystem::path film_ = folder_ / "film.exr";
};

// Every third of the calls that write a checkpoint or the film at the end. With --long all of them, of one render after another up to a
// hundred.
TEST_F(CommandLineResumeTest, KilledWithinAnyWriteItGoesOnWithTheSameBits)
{
    const bool isLong = std::getenv("GLIM_LONG") != nullptr;
    const int step = isLong ? 1 : 3;
    int kills = 0, whole = 0;
    int samples = 400;
    do {
        const std::string spp = std::to_string(samples), expected = digestOfOneRun(spp);
        bool done = false;
        for (int at = 1; !done || at < 4; at += step) {
            std::filesystem::remove(film_);
            const GlimRun killed = runGlim(failing(call({"--spp", spp, "--resume"}), at, "kill", folder_.path()));
            done = done || killed.signal == 0;
            kills += killed.signal == SIGKILL ? 1 : 0;
            EXPECT_TRUE(killed.signal == SIGKILL || killed.exitCode == 0) << killed.err;
            if (std::filesystem::exists(film_)) {
                whole += killed.signal != 0 ? 1 : 0;
                readFilm(film_);
            }
            expectDone({"--spp", spp, "--resume"});
            EXPECT_EQ(computeDigest(readFilm(film_)), expected) << "killed at call " << at;
            EXPECT_EQ(folder_.entries(), 1U) << "killed at call " << at;
        }
        std::filesystem::remove(film_);
        samples += 300;
    } while (isLong && kills < 100);
    EXPECT_GT(kills, 12 / step);  // as many as there are for the lock, one checkpoint and the end
    EXPECT_GT(whole, 0) << "a checkpoint was there when the end was being written";
    RecordProperty("kills", kills);
}

TEST_F(CommandLineResumeTest, KilledAtAnyMomentItGoesOnWithTheSameBits)
{
    const std::string expected = digestOfOneRun("3000");
    int kills = 0;
    for (std::size_t lines = 1;; ++lines) {
        GlimCall killed = call({"--spp", "3000", "--resume", "--checkpoint", "0.01s", "--progress", "json"});
        killed.signalWhen = [lines](const std::string& err) { return countLines(err) > lines; };
        killed.signal = lines % 2 == 0 ? SIGTERM : SIGKILL;
        const GlimRun run = runGlim(killed);
        if (run.exitCode == 0) {
            break;
        }
        ++kills;
        ASSERT_LT(kills, 30);
    }
    EXPECT_GT(kills, 1);
    EXPECT_EQ(computeDigest(readFilm(film_)), expected);
    EXPECT_EQ(folder_.entries(), 1U);
}

TEST_F(CommandLineResumeTest, GoesOnFromAFilmOfFewerSamples)
{
    const std::string expected = digestOfOneRun("640");
    expectDone({"--spp", "256"});
    expectDone({"--spp", "300", "--resume"});
    const GlimRun run = runForMessages(call({"--spp", "640", "--resume"}));
    expectSaid(run, MessageId::Resumed, {.file = film_, .value = "256"});  // the last block was not whole
    EXPECT_EQ(computeDigest(readFilm(film_)), expected);
    const std::string before = readFileBytes(film_);
    const GlimRun fewer = runGlim(call({"--spp", "300", "--resume"}));
    EXPECT_EQ(fewer.exitCode, 0) << fewer.err;
    EXPECT_NE(fewer.out.find("is whole and was kept"), std::string::npos) << fewer.out;
    EXPECT_EQ(readFileBytes(film_), before);
}

TEST_F(CommandLineResumeTest, NeighboursGoOn)
{
    expectDone({"--spp", "4096", "--adaptive", "neighbours"});
    const std::string expected = computeDigest(readFilm(film_));
    std::filesystem::remove(film_);
    GlimCall stopped = call({"--spp", "4096", "--adaptive", "neighbours", "--resume", "--progress", "json"});
    stopped.signalWhen = hasLine;
    stopped.signal = SIGINT;
    EXPECT_EQ(runGlim(stopped).exitCode, 128 + SIGINT);
    expectDone({"--spp", "4096", "--adaptive", "neighbours", "--resume"});
    EXPECT_EQ(computeDigest(readFilm(film_)), expected);
    expectRefused({"--spp", "8192", "--adaptive", "neighbours", "--resume"}, MessageId::Mismatch, {.place = "--spp"});
}

TEST_F(CommandLineResumeTest, UserSignalWritesAndGoesOn)
{
    const std::string expected = digestOfOneRun("4000");
    GlimCall asked = call({"--spp", "4000", "--progress", "json", "--checkpoint", "1h", "--on-checkpoint", "cp \"$GLIM_FILM\" seen.exr"});
    asked.signalWhen = hasLine;
    asked.signal = SIGUSR1;
    const GlimRun run = runGlim(asked);
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_EQ(computeDigest(readFilm(film_)), expected);
    EXPECT_NE(run.err.find("\"checkpoint\":{\"samplesPerPixel\":"), std::string::npos) << run.err;
    const Film seen = readFilm(folder_ / "seen.exr");
    EXPECT_LT(seen.sampleRanges.front().second, 4000U);
    EXPECT_TRUE(readStoredFilm(folder_ / "seen.exr").checkpoint);
    std::filesystem::rename(folder_ / "seen.exr", film_);
    expectDone({"--spp", "4000", "--resume"});
    EXPECT_EQ(computeDigest(readFilm(film_)), expected);
}

TEST_F(CommandLineResumeTest, FailedCommandsAndFullDisksAreSaidAndTheRenderGoesOn)
{
    const GlimRun run = runForMessages(call({"--spp", "300", "--checkpoint", "1m", "--on-checkpoint", "exit 7"}));
    EXPECT_EQ(run.exitCode, 0);
    expectSaid(run, MessageId::CommandFailed);
    EXPECT_TRUE(contains(run.err, "status 7")) << run.err;
    const std::string before = readFileBytes(film_);
    // After those of the lock.
    const GlimRun full = runForMessages(failing(call({"--spp", "600", "--resume"}), 6, "full", folder_.path()));
    EXPECT_EQ(full.exitCode, 1);
    expectSaid(full, MessageId::NoCheckpoint);
    expectSaid(full, MessageId::FileUnwritable, {.file = film_, .value = "No space left on device"});
    EXPECT_EQ(readFileBytes(film_), before);
    EXPECT_EQ(folder_.entries(), 1U);
}

// A checkpoint that cannot be written is said the 1st, 2nd, 4th, 8th ... time.
TEST_F(CommandLineResumeTest, MessagesThatRepeatBecomeRarer)
{
    GlimCall endless = failing(call({"--time", "2", "--checkpoint", "0.01s"}), 5, "full", folder_.path());
    const GlimRun full = runGlim(endless);
    EXPECT_EQ(full.exitCode, 1);
    const std::size_t lines = countLines(full.err);
    EXPECT_GE(lines, 4U) << full.err;
    EXPECT_LE(lines, 10U) << full.err;
    EXPECT_NE(full.err.find("No space left on device. (4 times in a row)"), std::string::npos) << full.err;
    EXPECT_EQ(full.err.find("(3 times"), std::string::npos) << full.err;
    EXPECT_EQ(folder_.entries(), 0U);
}

TEST_F(CommandLineResumeTest, OneProcessWrites)
{
    const std::filesystem::path lock = hiddenBeside(film_, ".lock");
    expectDone({"--spp", "32"});
    std::filesystem::create_symlink("film.exr", folder_ / "link.exr");
    writeText(lock, "glim 4711\n");
    const int held = open(lock.c_str(), O_RDWR);
    ASSERT_GE(held, 0);
    ASSERT_EQ(flock(held, LOCK_EX), 0);
    expectRefused({"--spp", "64", "--resume"}, MessageId::FileInUse, {.value = "4711"});
    expectRefused({"--spp", "64"}, MessageId::FileInUse, {.value = "4711"});
    const std::string link = (folder_ / "link.exr").string();
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"render", sceneFile("cornell.gltf"), "-o", link, "--size", "12x12"},
          {"merge", film_.string(), "-o", link}}) {
        test::expectRefused(runForMessages(arguments), 1, MessageId::FileInUse, {.file = link, .value = "4711"});
    }
    close(held);
    expectDone({"--spp", "64", "--resume"});
    EXPECT_EQ(folder_.entries(), 2U) << "the lock of a process that is gone is taken, and removed";
}

TEST_F(CommandLineResumeTest, WhatIsInPlaceOfTheLockIsRefusedAndLeft)
{
    const std::filesystem::path lock = hiddenBeside(film_, ".lock"), mine = folder_ / "mine";
    const auto expectLeft = [&](const std::filesystem::path& file, const std::string& content) {
        expectRefused({"--spp", "4"}, MessageId::UnknownFormat, {.file = lock});
        EXPECT_EQ(readFileBytes(file), content);
        EXPECT_TRUE(std::filesystem::exists(std::filesystem::symlink_status(lock)));
        std::filesystem::remove(lock);
    };
    writeText(mine, "mine");
    std::filesystem::create_symlink("mine", lock);
    expectLeft(mine, "mine");
    std::filesystem::create_symlink("nowhere", lock);
    expectLeft(mine, "mine");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "nowhere"));
    for (const char* content : {"mine", "4711", "glim 47 11\n", "glim \n"}) {
        writeText(lock, content);
        expectLeft(lock, content);
    }
    ASSERT_EQ(mkfifo(lock.c_str(), 0600), 0);
    expectRefused({"--spp", "4"}, MessageId::UnknownFormat, {.file = lock});
    std::filesystem::remove(lock);
    // What the user calls so, as flock(1) does, is none of glim's business.
    writeText(folder_ / "film.exr.lock", "mine");
    expectDone({"--spp", "4"});
    EXPECT_EQ(readFileBytes(folder_ / "film.exr.lock"), "mine");
}

TEST_F(CommandLineResumeTest, OtherFilmsAreRefusedAndLeft)
{
    expectDone({"--spp", "64"});
    expectRefused({"--spp", "128", "--resume", "--seed", "1"}, MessageId::Mismatch, {.place = "seed", .value = "0", .expected = "1"});
    expectRefused({"--spp", "128", "--resume", "--bounces", "3"}, MessageId::Mismatch,
                  {.place = "setting", .value = "\"bounces=64\"", .expected = "\"bounces=3\""});
    expectRefused({"--spp", "128", "--resume", "--size", "10x12"}, MessageId::Mismatch,
                  {.place = "size", .value = "12x12", .expected = "10x12"});
    expectRefused({"--spp", "128", "--resume", "--look-from", "0,1,2", "--look-at", "0,1,0"}, MessageId::Mismatch,
                  {.place = "scene, camera or environment"});
    expectRefused({"--samples", "256:512", "--resume"}, MessageId::Mismatch, {.value = "0:64", .expected = "at 256"});
    Film film = readFilm(film_);
    film.identity.kernels = "0123456789abcdef";
    writeFilm(film_, film);
    expectRefused({"--spp", "128", "--resume"}, MessageId::Mismatch, {.place = "kernels"});
    expectDone({"--spp", "300"});
    expectRefused({"--spp", "600", "--resume"}, MessageId::Unsupported, {.value = "0:300", .expected = "a page of 256"});
    writeText(film_, "no film");
    expectRefused({"--spp", "600", "--resume"}, MessageId::UnknownFormat, {.expected = "an OpenEXR file"});
}

TEST_F(CommandLineResumeTest, DamagedFilmsAreRefused)
{
    expectDone({"--spp", "400", "--resume"});
    ASSERT_TRUE(readStoredFilm(film_).checkpoint);
    const Image image = readExr(film_);
    for (const auto& [channel, part] : {std::pair{"R", "samples"}, {"page.R", "checkpoint"}}) {
        Image damaged = image;
        ASSERT_TRUE(damaged.channels.contains(channel));
        damaged.channels[channel][7] = std::nextafter(damaged.channels[channel][7], 1e9F);
        writeExr(film_, damaged);
        expectRefused({"--spp", "500", "--resume"}, MessageId::FileDamaged, {.place = part});
    }
    Image unsealed = image;
    unsealed.attributes.erase("glim:progressDigest");
    writeExr(film_, unsealed);
    expectRefused({"--spp", "500", "--resume"}, MessageId::UnknownFormat, {.place = "glim:progressDigest"});
    for (const char* progress : {"", "apart", "apart 384 999 384", "elsewhere 384 0 384", "apart 384 0 384 1 1"}) {
        Image damaged = image;
        damaged.attributes["glim:progress"] = progress;
        writeExr(film_, damaged);
        expectRefused({"--spp", "500", "--resume"}, MessageId::FileDamaged, {.place = "progress", .value = progress});
    }
}

// What rounds otherwise goes on, and the film says so for ever.
TEST_F(CommandLineResumeTest, AnotherArithmeticIsSaid)
{
    expectDone({"--spp", "256"});
    Film film = readFilm(film_);
    film.arithmetic = "0123456789abcdef";
    film.device = "another device";
    writeFilm(film_, film);
    const GlimRun run = runForMessages(call({"--spp", "512", "--resume"}));
    EXPECT_EQ(run.exitCode, 0) << run.err;
    expectSaid(run, MessageId::OtherRounding);
    EXPECT_FALSE(hasOneArithmetic(readFilm(film_)));
    GlimCall merge;
    merge.arguments = {"merge", film_.string(), "-o", film_.string()};
    EXPECT_NE(runGlim(merge).err.find("equal to a single run up to rounding"), std::string::npos);
}

TEST_F(CommandLineResumeTest, WhatCannotBeContinuedIsRefusedAtOnce)
{
    for (const auto& arguments : std::vector<std::vector<std::string>>{{"--resume", "--adaptive", "course"},
                                                                       {"--checkpoint", "5m", "--adaptive", "course"},
                                                                       {"--on-checkpoint", "true"},
                                                                       {"--checkpoint", "0s"},
                                                                       {"--checkpoint", "5 m"},
                                                                       {"--resume", "--suspects", "3"},
                                                                       {"--resume", "--replay", "1,1,1"}}) {
        const GlimRun run = runGlim(call(arguments));
        EXPECT_EQ(run.exitCode, 2) << run.err;
    }
    EXPECT_EQ(folder_.entries(), 0U);
}

}  // namespace
}  // namespace glim::test
