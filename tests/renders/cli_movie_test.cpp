// --movie: what ffmpeg is given, and what remains if it fails. A script stands in for it; where the real one is installed, it is tried too.
#include "host/image/decode_image.hpp"
#include "host/image/srgb.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <sstream>

namespace glim::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Keeps its words and its input, and writes a movie of four bytes. glim calls it twice: before the pictures and after them.
constexpr const char* kStandIn = R"(#!/bin/sh
printf '%s\n' "$@" > words
if [ -e fails ]; then printf "[a @ 0x12] Unknown encoder 'b'\nAnother line\n" >&2; exit 1; fi
if [ -e hangs ] && [ -e input ]; then echo $$ > hanging; exec sleep 100; fi
if [ -e fails-late ] && [ -e input ]; then exit 3; fi
cat > input
for last; do :; done
printf film > "$last"
)";

class MovieTest : public ::testing::Test {
protected:
    // A triangle that grows, and a light before it that grows much brighter, in a second; a wide camera that becomes wider.
    void SetUp() override
    {
        GltfBuilder builder;
        const std::size_t mesh = builder.addTriangleMesh();
        builder.append("materials", {{"doubleSided", true}, {"emissiveFactor", {1, 0.25, 0}}});
        builder.document["meshes"][mesh]["primitives"][0]["material"] = 0;
        builder.addNode({{"mesh", mesh}});
        builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 1.5}, {"znear", 0.1}}}});
        builder.addNode({{"camera", 0}, {"translation", {0.25, 0.25, 2}}});
        const auto pointer = [](const char* path) {
            return json{{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", path}}}}}};
        };
        const std::size_t times = builder.addAccessor(toBytes<float>({0, 1}), kFloat, "SCALAR", 2);
        const std::size_t ratios = builder.addAccessor(toBytes<float>({1.5F, 3}), kFloat, "SCALAR", 2);
        builder.append(
            "animations",
            {{"samplers",
              {{{"input", times}, {"output", builder.addVec3({0.1F, 0.02F, 0, 1, 0.25F, 0})}}, {{"input", times}, {"output", ratios}}}},
             {"channels",
              {{{"sampler", 0}, {"target", pointer("/materials/0/emissiveFactor")}},
               {{"sampler", 1}, {"target", pointer("/cameras/0/perspective/aspectRatio")}}}}});
        builder.document["extensionsUsed"] = {"KHR_animation_pointer"};
        writeText(folder_ / "scene.gltf", builder.toGltf());
        fs::create_directory(folder_ / "bin");
        writeText(folder_ / "bin/ffmpeg", kStandIn);
        fs::permissions(folder_ / "bin/ffmpeg", fs::perms::owner_all);
        call_.environment["PATH"] = (folder_ / "bin").string() + ":" + std::getenv("PATH");
        call_.folder = folder_.path();
    }
    GlimRun run(const std::vector<std::string>& options, const std::string& movie = "m.mp4")
    {
        call_.arguments = {"render", "scene.gltf", "--environment", environment_, "--spp", "4", "--movie", movie};
        call_.arguments.insert(call_.arguments.end(), options.begin(), options.end());
        return runForMessages(call_);
    }
    GlimRun expectDone(const std::vector<std::string>& options, const std::string& movie = "m.mp4")
    {
        GlimRun done = run(options, movie);
        EXPECT_EQ(done.exitCode, 0) << done.err;
        return done;
    }
    std::string bytesOf(const std::string& name) const { return readFileBytes(folder_ / name.c_str()); }
    bool isThere(const char* name) const { return fs::exists(folder_ / name); }
    DecodedImage picture(const std::string& name) const
    {
        const std::string bytes = bytesOf(name);
        return decodeImage({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
    }
    std::vector<std::string> words() const
    {
        std::istringstream lines(bytesOf("words"));
        std::vector<std::string> words;
        for (std::string line; std::getline(lines, line);) {
            words.push_back(line);
        }
        return words;
    }
    std::string wordAfter(const std::string& word) const
    {
        const std::vector<std::string> all = words();
        const auto found = std::ranges::find(all, word);
        return found == all.end() || found + 1 == all.end() ? "" : found[1];
    }

    ScratchFolder folder_;
    GlimCall call_;
    std::string environment_ = "0.1,0.2,0.4";
    const std::vector<std::string> two_{"--frames", "0:24:24", "--size", "12x8", "-o", "p.##.png"};
};

TEST_F(MovieTest, IsOfThePicturesOneAfterTheOther)
{
    const GlimRun done = expectDone({"--frames", "0:24:12", "--size", "13x9", "--zoom", "2.5", "-o", "p.##.png"});
    EXPECT_EQ(bytesOf("m.mp4"), "film");
    EXPECT_TRUE(contains(done.out, "m.mp4: 3 pictures, 1.5 s at 2 a second\n")) << done.out;
    EXPECT_EQ(folder_.entries(), 2 + 2 + 3 + 1) << "the scene, bin, what the script kept, the pictures and the movie";
    // The odd sides are repeated.
    std::string expected;
    for (const char* name : {"p.00.png", "p.12.png", "p.24.png"}) {
        const DecodedImage image = picture(name);
        for (std::size_t y = 0; y < 10; ++y) {
            for (std::size_t x = 0; x < 14; ++x) {
                const std::uint8_t* pixel = &image.rgba8[4 * (std::min<std::size_t>(y, 8) * 13 + std::min<std::size_t>(x, 12))];
                expected.append(pixel, pixel + 3);
            }
        }
    }
    EXPECT_EQ(bytesOf("input"), expected);
    EXPECT_EQ(wordAfter("-video_size"), "14x10");
    EXPECT_EQ(wordAfter("-framerate"), "2") << "24 a second, of which every twelfth is drawn";
}

TEST_F(MovieTest, SaysWhatKindItIsAndWhichColours)
{
    expectDone(two_);
    EXPECT_EQ(wordAfter("-c:v"), "libx264");
    for (const auto& [word, value] : {std::pair("-color_primaries", "bt709"),
                                      {"-color_trc", "iec61966-2-1"},
                                      {"-colorspace", "bt709"},
                                      {"-color_range", "tv"},
                                      {"-pixel_format", "rgb24"}}) {
        EXPECT_EQ(wordAfter(word), value);
    }
    EXPECT_EQ(words().back(), "/proc/self/fd/3");
    EXPECT_EQ(words().end()[-2], "mp4");
    expectDone({"--turntable", "2", "--fps", "30", "--size", "12x8", "-o", "p.##.png"}, "m.WebM");
    EXPECT_EQ(wordAfter("-c:v"), "libvpx-vp9");
    EXPECT_EQ(words().end()[-2], "webm");
    EXPECT_EQ(wordAfter("-framerate"), "30");
}

TEST_F(MovieTest, FfmpegIsAskedBeforeTheFirstPicture)
{
    writeText(folder_ / "fails", "");
    expectRefused(run(two_), 1, MessageId::ProgramFailed, {.file = "m.mp4", .place = "ffmpeg", .value = "Unknown encoder 'b'"});
    fs::remove(folder_ / "bin/ffmpeg");
    call_.environment["PATH"] = (folder_ / "bin").string();
    expectRefused(run(two_), 1, MessageId::ProgramMissing, {.file = "m.mp4", .expected = "ffmpeg"});
    EXPECT_FALSE(isThere("p.00.png") || isThere("m.mp4"));
}

TEST_F(MovieTest, AFailureLeavesThePicturesAndTheMovieBefore)
{
    writeText(folder_ / "m.mp4", "before");
    writeText(folder_ / "fails-late", "");
    const GlimRun done = run(two_);
    EXPECT_EQ(done.exitCode, 1) << done.err;
    expectSaid(done, MessageId::ProgramFailed, {.file = "m.mp4", .place = "ffmpeg"});
    EXPECT_TRUE(isThere("p.00.png") && isThere("p.24.png"));
    EXPECT_EQ(bytesOf("m.mp4"), "before");
}

TEST_F(MovieTest, ASignalEndsFfmpegToo)
{
    writeText(folder_ / "hangs", "");
    call_.signal = SIGTERM;
    call_.signalWhen = [this](const std::string&) { return !bytesOf("hanging").empty(); };
    const GlimRun done = run(two_);
    EXPECT_EQ(done.exitCode, 143) << done.err;
    expectSaid(done, MessageId::StoppedBySignal);
    EXPECT_TRUE(isThere("p.24.png"));
    EXPECT_FALSE(isThere("m.mp4"));
    EXPECT_EQ(kill(std::stoi(bytesOf("hanging")), 0), -1);
    EXPECT_EQ(errno, ESRCH);
}

TEST_F(MovieTest, PicturesHaveOneSizeAndOneExposure)
{
    const std::vector<std::string> frames{"--frames", "0:24:24", "--exposure", "auto", "-o", "p.##.exr", "--image", "p.##.png"};
    const GlimRun done = expectDone(frames);
    for (const char* name : {"p.00.png", "p.24.png"}) {
        EXPECT_EQ(picture(name).width, 768U) << name;
        EXPECT_EQ(picture(name).height, 512U) << name;
    }
    const std::optional<Message> chosen = findMessage(done, MessageId::ExposureChosen);
    ASSERT_TRUE(chosen);
    EXPECT_EQ(contains(done.err.substr(done.err.find("exposure-chosen") + 1), "exposure-chosen"), false) << "of the first alone";
    const std::string second = bytesOf("p.24.png");
    EXPECT_TRUE(contains(expectDone(frames).out, "0 of 2 pictures rendered"));
    EXPECT_EQ(bytesOf("p.24.png"), second) << "the films are kept, and drawn the same again";
    expectDone({"--frames", "24:24", "--size", "768x512", "--exposure", chosen->value, "-o", "p.##.exr", "--image", "q.##.png"});
    EXPECT_EQ(bytesOf("q.24.png"), second);
    // Alone it would have an exposure of its own.
    expectDone({"--frames", "24:24", "--size", "768x512", "--exposure", "auto", "-o", "p.##.exr", "--image", "q.##.png"});
    EXPECT_NE(bytesOf("q.24.png"), second);
}

TEST_F(MovieTest, IsBlackWherePicturesAreTransparent)
{
    std::vector<std::string> options = two_;
    options.insert(options.end(), {"--environment-background", "off"});
    expectSaid(expectDone(options), MessageId::AlphaLost, {.file = "m.mp4"});
    const DecodedImage image = picture("p.00.png");
    const std::string input = bytesOf("input");
    std::size_t parts = 0;
    for (std::size_t i = 0; i < 4UL * 12 * 8; ++i) {
        const double alpha = image.rgba8[i / 4 * 4 + 3] / 255.0, shown = alpha * linearFromSrgb(image.rgba8[i] / 255.0);
        parts += alpha > 0.0 && alpha < 1.0 ? 1U : 0U;
        if (i % 4 != 3) {
            EXPECT_NEAR(static_cast<unsigned char>(input[i / 4 * 3 + i % 4]), 255.0 * srgbFromLinear(shown), 0.5 + 1e-6) << i;
        }
    }
    EXPECT_GT(parts, 4U);
}

// Of a saturated colour in the corner: another matrix or range would shift it by ten levels or more. Rounding of luma, of chroma and in
// decoding, which truncates, come to three.
TEST_F(MovieTest, OfTheRealProgramHasTheColoursOfThePictures)
{
    fs::remove(folder_ / "bin/ffmpeg");
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) {
        GTEST_SKIP() << "ffmpeg is not installed";
    }
    environment_ = "0.05,0.6,0.1";
    for (const std::string movie : {"m.mp4", "m.webm"}) {
        expectDone({"--turntable", "3", "--size", "65x33", "-o", "p.##.png"}, movie);
        const std::string decode =
            "cd '" + folder_.path().string() + "' && ffmpeg -v error -y -i " + movie + " -f rawvideo -pix_fmt rgb24 raw";
        ASSERT_EQ(std::system(decode.c_str()), 0);
        const std::string raw = bytesOf("raw");
        ASSERT_EQ(raw.size(), 3UL * 66 * 34 * 3);
        for (int i = 0; i < 3; ++i) {
            const DecodedImage image = picture("p.0" + std::to_string(i) + ".png");
            for (std::size_t channel = 0; channel < 3; ++channel) {
                EXPECT_NEAR(static_cast<unsigned char>(raw[3UL * 66 * 34 * i + channel]), image.rgba8[channel], 3) << movie << i << channel;
            }
        }
    }
}

}  // namespace
}  // namespace glim::test
