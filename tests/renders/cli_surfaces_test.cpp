// render --surfaces, --objects and --layers: beside the picture, whose bits stay.
#include "host/image/exr.hpp"
#include "host/json.hpp"
#include "host/render/film_file.hpp"
#include "host/scene/scene.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace glim::test {
namespace {

class SurfaceFilesTest : public testing::Test {
protected:
    GlimRun render(const std::vector<std::string>& options, const std::string& scene = sceneFile("cornell_spheres.gltf")) const
    {
        GlimCall call;
        call.arguments = {"render", scene, "-o", "x.exr", "--size", "24x16", "--spp", "8"};
        call.arguments.insert(call.arguments.end(), options.begin(), options.end());
        call.folder = folder_.path();
        return runForMessages(call);
    }
    Film film() const { return readFilm(folder_ / "x.exr"); }
    Image image(const char* name) const { return readExr(folder_ / name); }
    Json objects() const { return *Json::parse(readFileBytes(folder_ / "o.json")); }

    ScratchFolder folder_;
};

TEST_F(SurfaceFilesTest, ChangeNoBitOfThePicture)
{
    ASSERT_EQ(render({}).exitCode, 0);
    const Film plain = film();
    ASSERT_EQ(render({"--surfaces", "s.exr", "--objects", "o.json", "--layers", "l.exr"}).exitCode, 0);
    EXPECT_TRUE(sameBits(plain, film()));
    const Image surfaces = image("s.exr");
    EXPECT_EQ(surfaces.channels.size(), 6U);
    EXPECT_EQ(surfaces.channels.count("forwardFlow.X"), 0U);
    EXPECT_EQ(surfaces.counts.count("instance.X"), 1U);
    EXPECT_TRUE(surfaces.attributes.contains("glim:camera"));
    EXPECT_EQ(objects().at("images").at(std::size_t{0}).at("file_name").text(), "x.exr");
    EXPECT_EQ(image("l.exr").channels.size(), 11U);
}

// The ray through the centre of a pixel is one of its rays, and instances are those that the ids name.
TEST_F(SurfaceFilesTest, AgreeWithTheLayersOfTheFilmAndTheIds)
{
    ASSERT_EQ(render({"--surfaces", "s.exr", "--objects", "o.json", "--ids", "i.exr"}).exitCode, 0);
    const Film picture = film();
    const Image surfaces = image("s.exr"), ids = image("i.exr");
    const Json named = objects();
    const auto& instances = named.at("instances").elements();
    std::size_t same = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const std::uint32_t instance = surfaces.counts.at("instance.X")[i];
        if (instance == kNoIndex) {
            same += ids.counts.at("node.X")[i] == kNoIndex;
            continue;
        }
        ASSERT_LT(instance, instances.size());
        EXPECT_GE(surfaces.channels.at("distance.Y")[i], 0.97F * picture.pixels[i].depth) << i;
        same += instances[instance].at("node").count() == ids.counts.at("node.X")[i];
    }
    EXPECT_GT(same, picture.pixels.size() * 95 / 100);
}

TEST_F(SurfaceFilesTest, OfACropAreThoseOfItsPart)
{
    ASSERT_EQ(render({"--surfaces", "s.exr", "--image", "w.png"}).exitCode, 0);
    const Image whole = image("s.exr");
    ASSERT_EQ(render({"--surfaces", "s.exr", "--crop", "5,3,10,8", "--ids", "i.exr"}).exitCode, 0);
    const Image part = image("s.exr");
    EXPECT_EQ(image("i.exr").columnsLeft, 5U);
    EXPECT_EQ(image("x.exr").rowsAbove, 3U);
    for (std::uint32_t y = 0; y < 8; ++y) {
        for (std::uint32_t x = 0; x < 10; ++x) {
            const std::size_t i = std::size_t{y} * 10 + x, k = std::size_t{y + 3} * 24 + x + 5;
            EXPECT_EQ(part.counts.at("instance.X")[i], whole.counts.at("instance.X")[k]);
            EXPECT_NEAR(part.channels.at("position.Y")[i], whole.channels.at("position.Y")[k], 1e-5F);
        }
    }
}

TEST_F(SurfaceFilesTest, SayWhatHalvesDoNotHold)
{
    expectSaid(render({"--environment", "1e6,1e6,1e6", "--environment-background", "on", "--layers", "l.exr", "--look-from", "0,0,9",
                       "--look-at", "0,0,20"}),
               MessageId::HalfOverflow, {.file = "l.exr"});
    EXPECT_FALSE(hasSaid(render({"--layers", "l.exr"}), MessageId::HalfOverflow));
}

TEST_F(SurfaceFilesTest, RefuseWhatDoesNotFit)
{
    expectRefused(render({"--surfaces", "s.exr", "--flow", "1"}), 2, MessageId::Requires,
                  {.place = "--flow", .expected = "--at or --frames"});
    expectRefused(render({"--flow", "1", "--at", "1"}), 2, MessageId::Requires, {.place = "--flow"});
    expectRefused(render({"--surfaces", "x.exr"}), 2, MessageId::Duplicate, {.place = "--surfaces", .expected = "--output"});
    expectRefused(render({"--objects", "o.json", "--stats", "o.json"}), 2, MessageId::Duplicate,
                  {.place = "--stats", .expected = "--objects"});
    expectRefused(render({"--rows", "0:8", "--objects", "o.json"}), 2, MessageId::Conflict, {.place = "--objects"});
    expectRefused(render({"--crop", "20,0,5,5"}), 1, MessageId::OutOfRange, {.place = "--crop", .expected = "24x16"});
    expectRefused(render({"--crop", "0,0,0,5"}), 2, MessageId::OutOfRange, {.place = "--crop"});
}

}  // namespace
}  // namespace glim::test
