// --shutter by the command line: frames, merged and continued films, other layers, and what does not fit it.
#include "host/image/exr.hpp"
#include "host/render/film_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/moving_file.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim::test {
namespace {

class ShutterTest : public testing::Test {
protected:
    ShutterTest()
    {
        MovingFile file;
        file.move("translation", {0.0F, 1.0F, 2.0F}, {-1, 0, 0, 1, 0, 0, 1, 0.2F, 0});
        file.moveCamera("translation", {0.0F, 2.0F}, {0, 0, 5, 0.5F, 0, 4});
        writeText(folder_ / "scene.gltf", file.toGltf());
    }
    GlimRun run(std::vector<std::string> arguments) const
    {
        GlimCall call;
        call.arguments = {"render", "scene.gltf", "--size", "24x16", "--environment", "1,0.8,0.6"};
        call.arguments.insert(call.arguments.end(), arguments.begin(), arguments.end());
        call.folder = folder_.path();
        return runForMessages(call);
    }
    Film render(std::vector<std::string> arguments, const char* name = "x.exr") const
    {
        arguments.insert(arguments.end(), {"-o", name});
        const GlimRun done = run(arguments);
        EXPECT_EQ(done.exitCode, 0) << done.err;
        return readFilm(folder_ / name);
    }

    ScratchFolder folder_;
};

TEST_F(ShutterTest, BlursWhatMoves)
{
    const Film sharp = render({"--at", "0.5"}), blurred = render({"--at", "0.5", "--shutter", "-0.25,0.25"});
    EXPECT_FALSE(sameBits(sharp, blurred));
    EXPECT_NE(sharp.identity.scene, blurred.identity.scene);
    EXPECT_FALSE(sameBits(blurred, render({"--at", "0.5", "--shutter", "0,0.25"})));
    // Nothing moves after the last key, and then it is the same scene.
    const Film after = render({"--at", "7"}), open = render({"--at", "7", "--shutter", "0,1"});
    EXPECT_TRUE(sameBits(after, open));
    EXPECT_EQ(after.identity.scene, open.identity.scene);
}

// A session that goes from frame to frame, from what moves to what does not and back, has the pictures of each frame alone.
TEST_F(ShutterTest, FramesAreThePicturesOfTheirTimes)
{
    const std::vector<std::string> options{"--shutter", "-0.1,0.1", "--spp", "8"};
    std::vector<std::string> frames{"--frames", "0:4", "--fps", "1.25", "-o", "f#.exr"};
    frames.insert(frames.end(), options.begin(), options.end());
    ASSERT_EQ(run(frames).exitCode, 0);
    for (const auto& [frame, at] : {std::pair("f0.exr", "0"), {"f1.exr", "0.8"}, {"f2.exr", "1.6"}, {"f3.exr", "2.4"}, {"f4.exr", "3.2"}}) {
        std::vector<std::string> alone{"--at", at};
        alone.insert(alone.end(), options.begin(), options.end());
        const Film one = render(alone), other = readFilm(folder_ / frame);
        EXPECT_TRUE(sameBits(one, other)) << frame;
        EXPECT_EQ(one.identity.scene, other.identity.scene) << frame;
        EXPECT_EQ(one.identity.settings, other.identity.settings) << frame;
    }
}

TEST_F(ShutterTest, IsPartOfAFilmsIdentity)
{
    const std::vector<std::string> moment{"--at", "0.5", "--shutter", "-0.1,0.3"};
    const auto with = [&moment](std::vector<std::string> more) {
        more.insert(more.begin(), moment.begin(), moment.end());
        return more;
    };
    const Film whole = render(with({"--samples", "0:128"}), "whole.exr");
    EXPECT_NE(whole.identity.settings.find(" shutter=-0.1,0.3"), std::string::npos) << whole.identity.settings;
    render(with({"--samples", "0:64"}), "a.exr");
    render(with({"--samples", "64:128"}), "b.exr");
    GlimCall merge;
    merge.arguments = {"merge", "a.exr", "b.exr", "-o", "merged.exr"};
    merge.folder = folder_.path();
    ASSERT_EQ(runForMessages(merge).exitCode, 0);
    EXPECT_TRUE(sameBits(whole, readFilm(folder_ / "merged.exr")));
    render(with({"--spp", "64"}), "c.exr");
    EXPECT_TRUE(sameBits(whole, render(with({"--spp", "128", "--resume"}), "c.exr")));
    expectRefused(run({"--at", "0.5", "--shutter", "-0.1,0.2", "--spp", "256", "--resume", "-o", "c.exr"}), 1, MessageId::Mismatch,
                  {.file = "c.exr"});
}

// Places at the centres of pixels are those of the frame's time, wherever that is while the shutter is open.
TEST_F(ShutterTest, SurfacesAreOfTheFramesTime)
{
    const auto surfacesOf = [&](const std::vector<std::string>& options) {
        std::vector<std::string> all{"--at", "0.5", "--spp", "1", "--surfaces", "s.exr", "--flow", "0.1"};
        all.insert(all.end(), options.begin(), options.end());
        render(all);
        return readExr(folder_ / "s.exr");
    };
    const Image sharp = surfacesOf({});
    std::size_t met = 0;
    for (const char* shutter : {"0,0.5", "-0.5,0", "-0.2,0.3"}) {
        const Image blurred = surfacesOf({"--shutter", shutter});
        for (const char* channel : {"position.X", "position.Y", "distance.Y", "forwardFlow.X"}) {
            const std::vector<float>&a = sharp.channels.at(channel), &b = blurred.channels.at(channel);
            for (std::size_t i = 0; i < a.size(); ++i) {
                met += std::isfinite(a[i]) ? 1 : 0;
                EXPECT_TRUE(std::isfinite(a[i]) ? std::abs(a[i] - b[i]) <= 2e-5F * (1.0F + std::abs(a[i])) : !std::isfinite(b[i]))
                    << channel << ' ' << i << ": " << a[i] << ", " << b[i];
            }
        }
    }
    EXPECT_GT(met, 100U);
}

// Samples that are traced again have their times again.
TEST_F(ShutterTest, IdsAndReplaysAreOfTheSamples)
{
    const Film film = render({"--at", "0.5", "--shutter", "-0.5,0.5", "--spp", "16", "--ids", "i.exr"});
    const Image ids = readExr(folder_ / "i.exr");
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        EXPECT_NEAR(ids.channels.at("CryptoObject00.G")[i], film.pixels[i].alpha, 1e-6F) << i;
    }
    double sum = 0.0;
    for (int sample = 0; sample < 4; ++sample) {
        const GlimRun replay =
            run({"--at", "0.5", "--shutter", "-0.5,0.5", "--replay", "12,7," + std::to_string(sample), "--stats", "r.json"});
        ASSERT_EQ(replay.exitCode, 0) << replay.err;
        sum += Json::parse(readFileBytes(folder_ / "r.json"))->at("radiance").at(std::size_t{0}).number() / 4.0;
    }
    const Film four = render({"--at", "0.5", "--shutter", "-0.5,0.5", "--spp", "4"});
    EXPECT_NEAR(sum, static_cast<double>(four.pixels[7 * 24 + 12].mean.r), 1e-6);
}

TEST_F(ShutterTest, SaysWhatStaysSharp)
{
    MovingFile file;
    file.move("translation", {0.0F, 1.0F}, {-1, 0, 0, 1, 0, 0});
    file.document["materials"] = {{{"emissiveFactor", {1, 1, 1}}}};
    file.document["meshes"][0]["primitives"][0]["material"] = 0;
    writeText(folder_ / "scene.gltf", file.toGltf());
    expectSaid(run({"--at", "0.5", "--shutter", "0,0.5", "-o", "x.exr"}), MessageId::StaysSharp, {.place = "nodes[1] (\"mover\")"});
    EXPECT_FALSE(hasSaid(run({"--at", "0.5", "-o", "x.exr"}), MessageId::StaysSharp));
}

TEST_F(ShutterTest, RefusesWhatDoesNotFit)
{
    const Parts shutter{.place = "--shutter"};
    expectRefused(run({"--shutter", "0,1", "-o", "x.exr"}), 2, MessageId::Requires, {.place = "--shutter", .expected = "--at or --frames"});
    for (const char* value : {"0.1,0.2", "-0.2,-0.1", "0,0", "0.5,-0.5", "0,1e9"}) {
        expectRefused(run({"--at", "1", "--shutter", value, "-o", "x.exr"}), 2, MessageId::OutOfRange, shutter);
    }
    for (const char* value : {"0.1", "0,x", "0,1,2", "0,nan"}) {
        expectRefused(run({"--at", "1", "--shutter", value, "-o", "x.exr"}), 2, MessageId::Malformed, shutter);
    }
    expectRefused(run({"--at", "1", "--shutter", "0,1", "--direct", "lights", "-o", "x.exr"}), 2, MessageId::Conflict, shutter);
    EXPECT_EQ(folder_.entries(), 1) << "nothing is written";
}

}  // namespace
}  // namespace glim::test
