// --fov and --zoom: how large a ball is in the picture, by the formula, whichever camera sees it.
#include "host/render/film_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/simulated_film.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

namespace glim::test {
namespace {

constexpr double kBallRadius = 1.0, kBallDistance = 5.0, kFileYfov = 0.6, kFileYmag = 2.5,
                 kHalfPixels = 24.0;  // pixels: half of the picture's height

class FieldTest : public ::testing::Test {
protected:
    // A ball before two cameras: 0 is perspective, 1 orthographic.
    void SetUp() override { writeScene("ball.gltf", true); }
    void writeScene(const char* name, bool withCameras) const
    {
        GltfBuilder builder;
        builder.addNode({{"extras", {{"sphere", {{"radius", kBallRadius}}}}}});
        if (withCameras) {
            builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", kFileYfov}, {"znear", 0.1}}}});
            builder.append("cameras", {{"name", "plan"},
                                       {"type", "orthographic"},
                                       {"orthographic", {{"xmag", kFileYmag}, {"ymag", kFileYmag}, {"znear", 0.1}, {"zfar", 10}}}});
            builder.addNode({{"camera", 0}, {"translation", {0, 0, kBallDistance}}});
            builder.addNode({{"camera", 1}, {"translation", {0, 0, kBallDistance}}});
        }
        writeText(folder_ / name, builder.toGltf());
    }
    GlimRun run(const char* scene, const std::vector<std::string>& options) const
    {
        GlimCall call;
        call.arguments = {"render", scene, "--size", "48x48", "--spp", "64", "--environment", "1,1,1"};
        call.arguments.insert(call.arguments.end(), options.begin(), options.end());
        call.folder = folder_.path();
        return runForMessages(call);
    }
    Film render(const std::vector<std::string>& options, const char* scene = "ball.gltf") const
    {
        std::vector<std::string> words{"-o", "a.exr"};
        words.insert(words.end(), options.begin(), options.end());
        const GlimRun done = run(scene, words);
        EXPECT_EQ(done.exitCode, 0) << done.err;
        return readFilm(folder_ / "a.exr");
    }
    // The ball's radius in pixels, by the share of the picture that it covers.
    static void expectRadius(const Film& film, double radius)
    {
        double area = 0.0, edge = 0.0;
        for (const PixelMoments& pixel : film.pixels) {
            area += static_cast<double>(pixel.alpha);
            edge += pixel.alpha > 0.0F && pixel.alpha < 1.0F ? 1.0 : 0.0;
        }
        // The share of 64 samples in a pixel has a standard error of 1/16 at most.
        EXPECT_NEAR(area, std::numbers::pi * radius * radius, 5.0 / 16.0 * std::sqrt(edge)) << "for a radius of " << radius;
    }
    // Of its outline, which is nearer than its middle, at a distance in a picture of this angle.
    static double outline(double distance, double angle)
    {
        return kHalfPixels * kBallRadius / std::sqrt(distance * distance - kBallRadius * kBallRadius) / std::tan(0.5 * angle);
    }

    ScratchFolder folder_;
};

double inRadians(double degrees) { return degrees * std::numbers::pi / 180.0; }

TEST_F(FieldTest, AreOfTheCameraInUse)
{
    expectRadius(render({}), outline(kBallDistance, kFileYfov));
    expectRadius(render({"--fov", "60"}), outline(kBallDistance, inRadians(60)));
    expectRadius(render({"--zoom", "0.5"}), 0.5 * outline(kBallDistance, kFileYfov));
    expectRadius(render({"--fov", "60", "--zoom", "1.5"}), 1.5 * outline(kBallDistance, inRadians(60)));
    const std::vector<std::string> placed{"--look-from", "0,8,0", "--look-at", "0,0,0", "--look-up", "1,0,0"};
    for (const auto& [words, radius] : {std::pair(std::vector<std::string>{"--fov", "20"}, outline(8, inRadians(20))),
                                        {{"--zoom", "2"}, 2.0 * outline(8, kFileYfov)},
                                        {{"--fov", "20", "--zoom", "0.5"}, 0.5 * outline(8, inRadians(20))}}) {
        std::vector<std::string> all = placed;
        all.insert(all.end(), words.begin(), words.end());
        expectRadius(render(all), radius);
    }
    expectRadius(render({"--camera", "plan"}), kHalfPixels * kBallRadius / kFileYmag);
    expectRadius(render({"--camera", "plan", "--zoom", "2"}), 2.0 * kHalfPixels * kBallRadius / kFileYmag);
}

// From another distance: the ball is as large in the picture, and nothing of it is cut.
TEST_F(FieldTest, AFramedCameraStandsWhereItsSubjectFits)
{
    writeScene("alone.gltf", false);
    for (const auto& [scene, words] : {std::pair("alone.gltf", std::vector<std::string>{}), {"ball.gltf", {"--camera", "framed"}}}) {
        std::vector<double> distances;
        for (const char* fov : {"10", "40", "100"}) {
            std::vector<std::string> all = words;
            all.insert(all.end(), {"--fov", fov});
            const Film film = render(all, scene);
            double nearest = 1e9, high = 0.0;
            for (std::size_t i = 0; i < film.pixels.size(); ++i) {
                const std::size_t x = i % film.width, y = i / film.width;
                if (x == 0 || y == 0 || x + 1 == film.width || y + 1 == film.height) {
                    EXPECT_EQ(film.pixels[i].alpha, 0.0F) << fov << ": it is cut at " << x << ", " << y;
                }
                nearest = std::min(nearest, static_cast<double>(film.pixels[i].depth));
                high += film.pixels[i].alpha > 0.5F && x == film.width / 2 ? 1.0 : 0.0;
            }
            EXPECT_GT(high, 0.4 * film.height) << fov;
            distances.push_back(nearest);
            all.insert(all.end(), {"--zoom", "0.5"});
            double area = 0.0, smaller = 0.0;
            const Film halved = render(all, scene);
            for (std::size_t i = 0; i < film.pixels.size(); ++i) {
                area += static_cast<double>(film.pixels[i].alpha);
                smaller += static_cast<double>(halved.pixels[i].alpha);
            }
            EXPECT_NEAR(smaller / area, 0.25, 0.01) << fov;
        }
        EXPECT_GT(distances[0], 2.0 * distances[1]);
        EXPECT_GT(distances[1], 2.0 * distances[2]);
    }
}

// The settings of a film have the options of its camera, by which it can be made again.
TEST_F(FieldTest, EachPictureOfATurntableHasThem)
{
    ASSERT_EQ(run("ball.gltf", {"--turntable", "2", "--fov", "15", "--zoom", "1.25", "-o", "t#.exr"}).exitCode, 0);
    for (const char* name : {"t0.exr", "t1.exr"}) {
        const Film film = readFilm(folder_ / name);
        std::istringstream settings(film.identity.settings);
        std::vector<std::string> words{"--camera", "framed"};
        for (std::string word; settings >> word;) {
            if (word.starts_with("look-") || word.starts_with("fov=") || word.starts_with("zoom=")) {
                words.push_back("--" + word);
            }
        }
        ASSERT_EQ(words.size(), 7U) << film.identity.settings;
        EXPECT_EQ(words[5], "--fov=15");
        EXPECT_EQ(words[6], "--zoom=1.25");
        const Film again = render(words);
        EXPECT_TRUE(sameBits(again.pixels, film.pixels)) << name;
        EXPECT_EQ(computeDigest(again), computeDigest(film)) << name;
    }
    ASSERT_EQ(run("ball.gltf", {"--camera", "all", "--zoom", "1.25", "-o", "c#.exr"}).exitCode, 0);
    expectRadius(readFilm(folder_ / "c0.exr"), 1.25 * outline(kBallDistance, kFileYfov));
    expectRadius(readFilm(folder_ / "c1.exr"), 1.25 * kHalfPixels * kBallRadius / kFileYmag);
}

TEST_F(FieldTest, NonsenseIsRefused)
{
    const auto expect = [this](std::vector<std::string> words, int exitCode, MessageId id, const Parts& parts) {
        words.insert(words.end(), {"-o", "a#.exr"});
        SCOPED_TRACE(words[1]);
        expectRefused(run("ball.gltf", words), exitCode, id, parts);
        EXPECT_EQ(folder_.entries(), 1) << "something was written";
    };
    for (const char* degrees : {"0", "180", "-30", "nan", "1e9"}) {
        expect({"--fov", degrees}, 2, MessageId::OutOfRange, {.place = "--fov", .value = degrees, .expected = "0.01 to 179"});
    }
    expect({"--fov", "wide"}, 2, MessageId::Malformed, {.place = "--fov", .value = "wide"});
    expect({"--zoom", "0"}, 2, MessageId::OutOfRange, {.place = "--zoom", .value = "0"});
    expect({"--fov", "30", "--cameras", "list.json"}, 2, MessageId::Conflict, {});
    expect({"--zoom", "3", "--cameras", "list.json"}, 2, MessageId::Conflict, {});
    expect({"--fov", "30", "--camera", "plan"}, 1, MessageId::Conflict, {.place = "--fov", .value = "plan", .expected = "--zoom"});
    expect({"--fov", "30", "--camera", "all"}, 1, MessageId::Conflict, {.place = "--fov", .value = "plan", .expected = "--zoom"});
    expect({"--zoom", "1e-6", "--fov", "179"}, 1, MessageId::OutOfRange, {.place = "--zoom", .value = "1e-06"});
}

}  // namespace
}  // namespace glim::test
