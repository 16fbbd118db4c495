// --focus: the plane in focus goes through what a pixel shows.
#include "host/render/film_file.hpp"
#include "host/render/settings.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glim::test {
namespace {

using nlohmann::json;

// A quad across the axis at this depth, from x0 to x1 and from -half to half; returns its node.
std::size_t addQuad(GltfBuilder& builder, float depth, float x0, float x1, float half, int material)
{
    const std::size_t corners = builder.addVec3({x0, -half, -depth, x1, -half, -depth, x1, half, -depth, x0, half, -depth});
    const std::size_t mesh = builder.addMesh(
        {{"attributes", {{"POSITION", corners}}}, {"indices", builder.addIndices({0, 1, 2, 0, 2, 3})}, {"material", material}});
    return builder.addNode({{"mesh", mesh}});
}

void addCamera(GltfBuilder& builder, const json& camera) { builder.addNode({{"camera", builder.append("cameras", camera)}}); }

// What the camera at the origin sees along -z: black at 2 m on the left, a square lamp of half a metre at 5 m on the right.
class FocusTest : public ::testing::Test {
protected:
    static constexpr float kNear = 2.0F, kFar = 5.0F, kHalfTangent = 0.5F;

    void SetUp() override
    {
        GltfBuilder builder;
        builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}}}});
        builder.append("materials", {{"emissiveFactor", {1, 1, 1}}});
        const std::size_t near = addQuad(builder, kNear, -10.0F, -0.25F, 10.0F, 0);
        addQuad(builder, kFar, 1.0F, 1.5F, 0.25F, 1);
        addCamera(builder, {{"type", "perspective"}, {"perspective", {{"yfov", 2 * std::atan(kHalfTangent)}, {"znear", 0.1}}}});
        addCamera(builder, {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}});
        const std::size_t times = builder.addAccessor(toBytes<float>({0, 1}), kFloat, "SCALAR", 2);
        builder.append("animations", {{"samplers", {{{"input", times}, {"output", builder.addVec3({0, 0, 0, 0, 0, -1})}}}},
                                      {"channels", {{{"sampler", 0}, {"target", {{"node", near}, {"path", "translation"}}}}}}});
        writeText(folder_ / "scene.gltf", builder.toGltf());
    }
    GlimRun run(std::vector<std::string> options) const
    {
        GlimCall call;
        call.arguments = {"render", "scene.gltf", "--size", "64x48", "--environment", "none", "--lens-radius", "0.2"};
        const bool isSequence = std::ranges::find(options, "--frames") != options.end();
        const std::vector<std::string> output =
            isSequence ? std::vector<std::string>{"-o", "f#.exr"} : std::vector<std::string>{"-o", "f.exr", "--at", "0"};
        options.insert(options.end(), output.begin(), output.end());
        call.arguments.insert(call.arguments.end(), options.begin(), options.end());
        call.folder = folder_.path();
        return runForMessages(call);
    }
    Film render(const std::vector<std::string>& options, const char* name = "f.exr") const
    {
        const GlimRun done = run(options);
        EXPECT_EQ(done.exitCode, 0) << done.err;
        return readFilm(folder_ / name);
    }
    static std::string distanceOf(const Film& film) { return findSetting(film.identity.settings, "focal-distance"); }
    // Within the rounding of a ray's direction, its length and their product to float32.
    static void expectDepth(const Film& film, float depth)
    {
        const float distance = std::stof(distanceOf(film));
        EXPECT_NEAR(distance, depth, 4.0F * std::numeric_limits<float>::epsilon() * depth);
    }

    ScratchFolder folder_;
};

TEST_F(FocusTest, IsTheDepthAlongTheAxisOfWhatThePixelShows)
{
    const std::pair<std::vector<std::string>, float> kCases[] = {
        {{"--focus", "1,46"}, kNear},
        {{"--focus", "44,24"}, kFar},
        {{"--focus", "44,24", "--zoom", "1.1"}, kFar},
        {{"--focus", "44,23", "--shift", "0.02,0.01"}, kFar},
        {{"--focus", "43,24", "--intrinsics", "50,45,30,24", "--distortion", "-0.1,0.02,0.01,-0.01"}, kFar},
        {{"--focus", "46,24", "--camera", "1"}, kFar},
        {{"--focus", "44,24", "--crop", "0,0,8,8"}, kFar},
        {{"--focus", "44,24", "--rows", "40:48", "--schedule", "wavefront"}, kFar},
        {{"--focus", "44,24", "--accelerator", "none"}, kFar},
    };
    for (const auto& [options, depth] : kCases) {
        SCOPED_TRACE(options.back());
        std::vector<std::string> words = options;
        words.insert(words.end(), {"--spp", "1", "--bounces", "1"});
        expectDepth(render(words), depth);
    }
}

TEST_F(FocusTest, HasTheBitsOfItsDistance)
{
    const std::vector<std::string> options{"--spp", "4"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), options.begin(), options.end());
        return more;
    };
    const GlimRun done = run(with({"--focus", "44,23"}));
    const std::optional<Message> said = findMessage(done, MessageId::FocusFound);
    ASSERT_TRUE(said) << done.err;
    const Film film = readFilm(folder_ / "f.exr");
    EXPECT_EQ(said->value, distanceOf(film));
    const Film same = render(with({"--focal-distance", said->value}));
    EXPECT_TRUE(sameBits(film, same));
    EXPECT_EQ(film.identity.settings, same.identity.settings);
    EXPECT_EQ(film.identity.scene, same.identity.scene);
    // So it is continued, too.
    EXPECT_TRUE(hasSaid(run({"--spp", "128", "--focus", "44,23", "--resume"}), MessageId::BegunAnew));
}

TEST_F(FocusTest, OfASequenceFollowsThePixel)
{
    const Film first = render({"--spp", "1", "--frames", "0:1", "--fps", "1", "--focus", "3,24"}, "f0.exr");
    expectDepth(first, kNear);
    expectDepth(readFilm(folder_ / "f1.exr"), kNear + 1.0F);
    EXPECT_NE(run({"--spp", "1", "--frames", "0:1", "--fps", "1", "--focus", "3,24"}).out.find("0 of 2"), std::string::npos)
        << "both are kept";
}

// The lamp lights the pixels where a pinhole shows it, and no other, as long as it is in focus.
TEST_F(FocusTest, MakesSharpWhatThePixelShows)
{
    constexpr float kWidth = 64.0F, kHeight = 48.0F, kPixels = 0.5F * kHeight / kHalfTangent;  // of a tangent of 1
    const auto isOnLamp = [](std::size_t x, std::size_t y) {
        const float left = 0.5F * kWidth + kPixels * 1.0F / kFar, right = 0.5F * kWidth + kPixels * 1.5F / kFar;
        const float half = kPixels * 0.25F / kFar, column = static_cast<float>(x), row = static_cast<float>(y) - 0.5F * kHeight;
        return column + 1.0F > left && column < right && row + 1.0F > -half && row < half;
    };
    const auto countStray = [&](const Film& film) {
        std::size_t stray = 0;
        for (std::size_t i = 0; i < film.pixels.size(); ++i) {
            stray += film.pixels[i].mean.g > 0.0F && !isOnLamp(i % film.width, i / film.width) ? 1U : 0U;
        }
        return stray;
    };
    const std::vector<std::string> options{"--spp", "64", "--bounces", "0", "--focus"};
    const auto focusedOn = [&](const char* pixel) {
        std::vector<std::string> words = options;
        words.push_back(pixel);
        return render(words);
    };
    EXPECT_EQ(countStray(focusedOn("44,24")), 0U);
    EXPECT_GT(countStray(focusedOn("3,24")), 20U) << "out of focus the lamp spreads over 2.9 pixels more to each side";
}

TEST_F(FocusTest, NeedsASurfaceInThePicture)
{
    expectRefused(run({"--focus", "63,0"}), 1, MessageId::Empty, {.place = "--focus", .value = "63,0"});
    expectRefused(run({"--focus", "64,0"}), 1, MessageId::OutOfRange,
                  {.place = "--focus", .value = "64,0", .expected = "X from 0 to 63 and Y from 0 to 47"});
    expectRefused(run({"--focus", "0,48", "--crop", "0,0,8,8"}), 1, MessageId::OutOfRange, {.place = "--focus", .value = "0,48"});
    EXPECT_EQ(folder_.entries(), 1) << "nothing is written";
}

}  // namespace
}  // namespace glim::test
