// --denoise: what it adds to a film, and what it leaves as it was.
#include "host/image/exr.hpp"
#include "host/render/film_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/simulated_film.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <csignal>

namespace glim::test {
namespace {

using nlohmann::json;

class DenoiseTest : public ::testing::Test {
protected:
    GlimRun run(std::vector<std::string> arguments, const std::string& scene = "cornell_gems.gltf") const
    {
        GlimCall call;
        call.arguments = {"render", sceneFile(scene), "--size", "48x40", "--progress", "none"};
        call.arguments.insert(call.arguments.end(), arguments.begin(), arguments.end());
        call.folder = folder_.path();
        return runForMessages(call);
    }
    void expectDone(const std::vector<std::string>& arguments, const std::string& scene = "cornell_gems.gltf") const
    {
        const GlimRun done = run(arguments, scene);
        ASSERT_EQ(done.exitCode, 0) << done.err;
    }
    void expectUsage(const std::vector<std::string>& arguments, MessageId id, const Parts& parts) const
    {
        std::vector<std::string> all{"-o", "no.exr", "--denoise"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        expectRefused(run(all), 2, id, parts);
        EXPECT_FALSE(std::filesystem::exists(folder_ / "no.exr"));
    }
    json statistics(const char* name) const { return json::parse(readFileBytes(folder_ / name)); }

    ScratchFolder folder_;
};

// With light paths, and at counts of samples that end blocks and do not.
TEST_F(DenoiseTest, TheFilmKeepsItsBits)
{
    for (const char* samples : {"0:64", "0:100", "0:300", "256:512", "100:300"}) {
        expectDone({"--samples", samples, "-o", "plain.exr"});
        expectDone({"--samples", samples, "-o", "denoised.exr", "--denoise"});
        const Film plain = readFilm(folder_ / "plain.exr"), denoised = readFilm(folder_ / "denoised.exr");
        EXPECT_EQ(computeDigest(plain), computeDigest(denoised)) << samples;
    }
    expectDone({"--adaptive", "neighbours", "--spp", "300", "-o", "plain.exr"});
    expectDone({"--adaptive", "neighbours", "--spp", "300", "-o", "denoised.exr", "--denoise", "--stats", "a.json"});
    EXPECT_EQ(computeDigest(readFilm(folder_ / "plain.exr")), computeDigest(readFilm(folder_ / "denoised.exr")));
    EXPECT_GT(statistics("a.json").at("denoised").at("mse"), 0.0);
}

TEST_F(DenoiseTest, AddsLayersAndFigures)
{
    expectDone({"--spp", "128", "-o", "a.exr", "--denoise", "--png", "a.png", "--stats", "a.json"}, "cornell.gltf");
    expectDone({"--spp", "128", "-o", "b.exr", "--png", "b.png", "--stats", "b.json"}, "cornell.gltf");
    const Image image = readExr(folder_ / "a.exr");
    const auto radiance = readDenoised(folder_ / "a.exr");
    ASSERT_TRUE(radiance);
    EXPECT_FALSE(readDenoised(folder_ / "b.exr"));
    EXPECT_EQ(std::get<std::string>(image.attributes.at("glim:denoiser")), "non-local means");
    double sum = 0.0, changed = 0.0;
    for (std::size_t i = 0; i < radiance->size(); ++i) {
        EXPECT_EQ((*radiance)[i].g, image.channels.at("denoised.G")[i]);
        EXPECT_GE(image.channels.at("denoisedError.G")[i], 0.0F);
        sum += static_cast<double>(image.channels.at("G")[i]);
        changed += static_cast<double>(std::abs((*radiance)[i].g - image.channels.at("G")[i]));
    }
    EXPECT_GT(changed, 0.005 * sum);
    EXPECT_LT(changed, 0.2 * sum);
    EXPECT_NE(readFileBytes(folder_ / "a.png"), readFileBytes(folder_ / "b.png"));
    EXPECT_EQ(statistics("b.json")["denoised"], nullptr);
    const json known = statistics("a.json")["denoised"];
    EXPECT_LT(known["mse95"][0], known["mse"]);
    EXPECT_GT(known["mse95"][1], known["mse"]);
    EXPECT_LT(known["relmse"], known["noisyRelmse"]);
    // Both say how wrong the noisy picture is: one from blocks, the other from halves.
    const double ofHalves = known["noisyRelmse"], ofBlocks = statistics("a.json")["estimate"]["relmse"];
    EXPECT_NEAR(ofHalves / ofBlocks, 1.0, 0.3);
}

TEST_F(DenoiseTest, MergedFilmsAreThoseOfTheirSamples)
{
    expectDone({"--samples", "0:256", "-o", "a.exr", "--denoise"});
    expectDone({"--samples", "256:512", "-o", "b.exr", "--denoise"});
    expectDone({"--spp", "512", "-o", "whole.exr"});
    GlimCall call;
    call.arguments = {"merge", "a.exr", "b.exr", "-o", "merged.exr"};
    call.folder = folder_.path();
    EXPECT_EQ(runGlim(call).exitCode, 0);
    EXPECT_EQ(computeDigest(readFilm(folder_ / "merged.exr")), computeDigest(readFilm(folder_ / "whole.exr")));
    EXPECT_FALSE(readDenoised(folder_ / "merged.exr"));
}

TEST_F(DenoiseTest, EndsAtATargetOfTheDenoisedPicture)
{
    expectDone({"--target-relmse", "0.0008", "--denoise", "--denoised", "-o", "a.exr", "--stats", "a.json"}, "cornell.gltf");
    expectDone({"--target-relmse", "0.0008", "-o", "b.exr", "--stats", "b.json"}, "cornell.gltf");
    const json denoised = statistics("a.json"), noisy = statistics("b.json");
    EXPECT_EQ(denoised["stopReason"], "target");
    EXPECT_LE(denoised["denoised"]["relmse"], 0.0008);
    EXPECT_GT(denoised["estimate"]["relmse"], 0.0008);
    EXPECT_LT(denoised["samples"], noisy["samples"]);
}

TEST_F(DenoiseTest, FramesThatAreThereKeepTheirDenoisedPicture)
{
    const std::vector<std::string> turntable{"--turntable", "2", "--spp", "64", "-o", "f#.exr", "--png", "f#.png"};
    expectDone(turntable);
    std::vector<std::string> denoised = turntable;
    denoised.push_back("--denoise");
    const GlimRun first = run(denoised);  // the films have none yet
    EXPECT_NE(first.out.find("2 of 2 pictures rendered"), std::string::npos) << first.out;
    const std::string png = readFileBytes(folder_ / "f1.png");
    const GlimRun second = run(denoised);
    EXPECT_NE(second.out.find("0 of 2 pictures rendered"), std::string::npos) << second.out;
    EXPECT_EQ(readFileBytes(folder_ / "f1.png"), png);
}

TEST_F(DenoiseTest, RefusesWhatHasNoHalves)
{
    expectUsage({"--spp", "63"}, MessageId::OutOfRange, {.place = "--spp", .value = "63", .expected = "64 or more"});
    expectUsage({"--adaptive", "course"}, MessageId::Conflict,
                {.place = "--adaptive", .value = "course", .expected = "--adaptive neighbours or off"});
    expectUsage({"--view", "normal"}, MessageId::Conflict, {.place = "--view", .value = "normal", .expected = "no --denoise"});
    expectUsage({"--rows", "0:8"}, MessageId::Conflict, {.place = "--rows", .value = "0:8"});
    expectUsage({"--denoised"}, MessageId::Requires, {.place = "--denoised"});
}

TEST_F(DenoiseTest, RefusesWhatIsNoOpenImageDenoise)
{
    const std::vector<std::string> plain{"--spp", "64", "-o", "no.exr", "--oidn"};
    const auto runWith = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = plain;
        all.insert(all.end(), more.begin(), more.end());
        return run(all);
    };
    expectRefused(runWith({".", "--denoise"}), 1, MessageId::LibraryMissing, {.file = ".", .expected = "libOpenImageDenoise.so.2"});
    expectRefused(runWith({"none.so", "--denoise"}), 1, MessageId::LibraryMissing, {.file = "none.so"});
    expectRefused(runWith({"libm.so.6", "--denoise"}), 1, MessageId::LibraryFailed, {.file = "libm.so.6", .expected = "oidnNewDevice"});
    expectRefused(runWith({"libm.so.6"}), 2, MessageId::Requires, {.place = "--oidn", .expected = "--denoise"});
    EXPECT_FALSE(std::filesystem::exists(folder_ / "no.exr"));
}

// Of other samples by the way, and killed at any moment; the denoised picture too.
TEST_F(DenoiseTest, ResumedItHasTheBitsOfOneRun)
{
    std::string adaptive = "off";
    const auto call = [&](const std::string& spp) {
        GlimCall next;
        next.arguments = {
            "render", sceneFile("cornell_gems.gltf"), "--size", "48x40", "--denoise", "--resume", "-o", "a.exr", "--spp", spp, "--adaptive",
            adaptive};
        next.folder = folder_.path();
        return next;
    };
    const auto contents = [&] {
        const Film film = readFilm(folder_ / "a.exr");
        return std::pair(computeDigest(film), *readDenoised(folder_ / "a.exr"));
    };
    const auto renderAtOnce = [&] {
        EXPECT_EQ(runGlim(call("400")).exitCode, 0);
        const auto whole = contents();
        std::filesystem::remove(folder_ / "a.exr");
        return whole;
    };
    const auto whole = renderAtOnce();
    for (const char* spp : {"64", "100", "256", "400"}) {
        EXPECT_EQ(runGlim(call(spp)).exitCode, 0);
    }
    EXPECT_TRUE(contents() == whole);
    for (const char* sampling : {"off", "neighbours"}) {
        adaptive = sampling;
        std::filesystem::remove(folder_ / "a.exr");
        const auto expected = renderAtOnce();
        int kills = 0;
        for (std::size_t lines = 1;; ++lines) {
            GlimCall killed = call("400");
            killed.arguments.insert(killed.arguments.end(), {"--checkpoint", "0.01s", "--progress", "json"});
            killed.signalWhen = [lines](const std::string& err) { return countLines(err) > lines; };
            killed.signal = lines % 2 == 0 ? SIGTERM : SIGKILL;
            if (runGlim(killed).exitCode == 0) {
                break;
            }
            ASSERT_LT(++kills, 30);
        }
        EXPECT_GT(kills, 0);
        EXPECT_TRUE(contents() == expected) << sampling;
    }
}

TEST_F(DenoiseTest, FilmsWithoutHalvesAreNotResumed)
{
    expectDone({"--spp", "256", "-o", "a.exr", "--resume"});
    expectRefused(
        run({"--spp", "512", "-o", "a.exr", "--resume", "--denoise"}), 1, MessageId::Unsupported,
        {.file = "a.exr", .place = "--denoise", .value = "0:256", .expected = "a film by --denoise with --checkpoint or --resume"});
    std::filesystem::remove(folder_ / "a.exr");
    expectDone({"--spp", "256", "-o", "a.exr", "--resume", "--denoise"});
    expectDone({"--spp", "512", "-o", "a.exr", "--resume"});  // halves are no hindrance
    expectDone({"--spp", "512", "-o", "b.exr"});
    EXPECT_EQ(computeDigest(readFilm(folder_ / "a.exr")), computeDigest(readFilm(folder_ / "b.exr")));
    EXPECT_FALSE(readStoredFilm(folder_ / "a.exr").checkpoint->hasHalves());
}

// A signal ends the render: what there is is written, and not denoised.
TEST_F(DenoiseTest, IsLeftOutAtASignal)
{
    GlimCall call;
    call.arguments = {"render", sceneFile("cornell.gltf"), "--size", "64x64", "--spp", "1000000", "-o", "a.exr", "--denoise", "--progress",
                      "json"};
    call.folder = folder_.path();
    call.signalWhen = hasLine;
    call.signal = 15;
    const GlimRun ended = runForMessages(call);
    EXPECT_EQ(ended.exitCode, 143);
    expectSaid(ended, MessageId::NotDenoised);
    EXPECT_FALSE(readDenoised(folder_ / "a.exr"));
}

}  // namespace
}  // namespace glim::test
