// --floor and --catcher from the command line: transparent pictures with shadows, whatever writes them.
#include "host/image/decode_image.hpp"
#include "host/image/exr.hpp"
#include "host/render/composite.hpp"
#include "host/render/film_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace glim::test {
namespace {

class CommandLineCatcherTest : public ::testing::Test {
protected:
    // A ball above a table, whose material says that it catches shadows.
    void SetUp() override
    {
        GltfBuilder builder;
        builder.append("materials", {{"name", "ball"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.75, 1}}}}});
        builder.addNode({{"extras", {{"sphere", {{"radius", 1}, {"material", 0}}}}}});
        writeText(folder_ / "ball.gltf", builder.toGltf());
        builder.append("materials", {{"name", "table"}, {"extras", {{"shadowCatcher", true}}}});
        builder.addNode({{"translation", {0, -21, 0}}, {"extras", {{"sphere", {{"radius", 20}, {"material", 1}}}}}});
        writeText(folder_ / "table.gltf", builder.toGltf());
    }
    GlimRun run(const std::vector<std::string>& arguments) const
    {
        GlimCall call;
        call.arguments = arguments;
        call.folder = folder_.path();
        return runForMessages(call);
    }
    GlimRun render(const std::vector<std::string>& options) const
    {
        std::vector<std::string> arguments{"render",      "ball.gltf", "--size",    "24x20",   "--floor",       "lowest",
                                           "--catcher",   "floor",     "--sun",     "40,50,3", "--environment", "0.3,0.3,0.4",
                                           "--look-from", "1,2,6",     "--look-at", "0,0,0"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        GlimRun done = run(arguments);
        EXPECT_EQ(done.exitCode, 0) << done.err;
        return done;
    }
    DecodedImage decoded(const char* name) const
    {
        const std::string bytes = readFileBytes(folder_ / name);
        return decodeImage({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
    }
    Film film(const char* name) const { return readFilm(folder_ / name); }

    ScratchFolder folder_;
};

TEST_F(CommandLineCatcherTest, PicturesAreTransparentButForShadows)
{
    const GlimRun done = render({"--spp", "64", "-o", "a.exr", "--image", "a.png", "--layers", "l.exr", "--stats", "s.json"});
    const Film film = this->film("a.exr");
    const std::vector<PixelMoments> picture = pictureOf(film);
    const DecodedImage png = decoded("a.png");
    const Image stored = readExr(folder_ / "a.exr"), layers = readExr(folder_ / "l.exr");
    std::size_t clear = 0, full = 0, partly = 0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const int alpha = png.rgba8[4 * i + 3];
        EXPECT_EQ(alpha, std::lround(255.0F * std::clamp(picture[i].alpha, 0.0F, 1.0F))) << i;
        EXPECT_EQ(stored.channels.at("composite.A")[i], picture[i].alpha) << i;
        EXPECT_EQ(stored.channels.at("composite.G")[i], picture[i].mean.g) << i;
        EXPECT_EQ(stored.channels.at("R")[i], film.pixels[i].mean.r) << "the film has the floor";
        EXPECT_NEAR(layers.channels.at("A")[i], picture[i].alpha, 1e-3F) << i;
        clear += alpha < 3 ? 1U : 0U;
        full += alpha == 255 ? 1U : 0U;
        partly += alpha > 60 && alpha < 250 ? 1U : 0U;
    }
    EXPECT_GT(clear, 100U);
    EXPECT_GT(full, 20U);
    EXPECT_GT(partly, 20U) << "shadows";
    EXPECT_NE(done.out.find("RMSE of the shadows' alpha "), std::string::npos) << done.out;
    const auto statistics = nlohmann::json::parse(readFileBytes(folder_ / "s.json"));
    EXPECT_NEAR(statistics.at("alphaRmse").get<double>(), computeAlphaRmse(film).value(), 1e-9);
    EXPECT_FALSE(film.showsBackground);
}

TEST_F(CommandLineCatcherTest, AMaterialMaySayThatItCatches)
{
    const auto shares = [this](std::vector<std::string> options) {
        options.insert(options.begin(), {"render", "table.gltf", "--size", "16x12", "--spp", "4", "-o", "t.exr"});
        EXPECT_EQ(run(options).exitCode, 0);
        const Film film = this->film("t.exr");
        return std::ranges::count_if(film.catcher, [](const CatcherMoments& catcher) { return catcher.share == 1.0F; });
    };
    EXPECT_GT(shares({}), 10);
    EXPECT_EQ(shares({"--set", "/materials/table/extras/shadowCatcher=false"}), 0);
}

TEST_F(CommandLineCatcherTest, FilmsResumeAndMergeToTheBitsOfOneRun)
{
    render({"--spp", "512", "-o", "all.exr"});
    const std::string digest = computeDigest(film("all.exr"));
    render({"--spp", "300", "-o", "some.exr", "--checkpoint", "1h"});
    render({"--spp", "512", "-o", "some.exr", "--resume"});
    EXPECT_EQ(computeDigest(film("some.exr")), digest);
    render({"--samples", "0:256", "-o", "a.exr"});
    render({"--samples", "256:512", "-o", "b.exr"});
    EXPECT_EQ(run({"merge", "b.exr", "a.exr", "-o", "ab.exr", "--image", "ab.png"}).exitCode, 0);
    EXPECT_EQ(computeDigest(film("ab.exr")), digest);
    render({"--spp", "512", "-o", "all.png", "--no-denoise"});
    EXPECT_EQ(decoded("ab.png").rgba8, decoded("all.png").rgba8);
    for (const char* rows : {"0:7", "7:20"}) {
        render({"--rows", rows, "--spp", "512", "-o", std::string("rows") + rows[0] + ".exr"});
    }
    EXPECT_EQ(run({"merge", "rows0.exr", "rows7.exr", "-o", "rows.exr"}).exitCode, 0);
    EXPECT_EQ(computeDigest(film("rows.exr")), digest);
    render({"--spp", "512", "-o", "few.exr", "--path-capacity", "128"});
    EXPECT_EQ(computeDigest(film("few.exr")), digest);
}

TEST_F(CommandLineCatcherTest, FilmsWithAndWithoutReflectionsAreNotMerged)
{
    render({"--samples", "0:32", "-o", "a.exr"});
    render({"--samples", "32:64", "-o", "b.exr", "--catcher-reflections", "off"});
    expectRefused(run({"merge", "a.exr", "b.exr", "-o", "ab.exr"}), 1, MessageId::Mismatch, {.value = "\"catcher=shadows\""});
}

TEST_F(CommandLineCatcherTest, AdaptiveFilmsKnowTheirShadows)
{
    render({"--spp", "128", "--adaptive", "neighbours", "-o", "a.exr"});
    EXPECT_EQ(film("a.exr").catcher.size(), 480U);
    render({"--target-rmse", "5%", "-o", "b.exr"});
    EXPECT_TRUE(computeAlphaRmse(film("b.exr")));
}

TEST_F(CommandLineCatcherTest, TheyAreNotDenoisedWhichIsSaid)
{
    expectSaid(render({"--spp", "64", "--denoise", "-o", "a.exr"}), MessageId::NotDenoised);
    render({"--spp", "64", "-o", "plain.exr"});
    EXPECT_EQ(computeDigest(film("a.exr")), computeDigest(film("plain.exr")));
    const GlimRun refused = run({"render", "table.gltf", "--denoise", "--denoised", "--target-rmse", "5%", "-o", "a.exr"});
    EXPECT_EQ(refused.exitCode, 1);
    expectSaid(refused, MessageId::Conflict, {.place = "--denoised"});
}

TEST_F(CommandLineCatcherTest, OtherViewsAndEstimatorsShowTheFloor)
{
    for (const std::vector<std::string>& options :
         {std::vector<std::string>{"--view", "depth"}, {"--direct", "lights"}, {"--adaptive", "course", "--max-spp", "32"}}) {
        std::vector<std::string> all = options;
        all.insert(all.end(), {"-o", "a.exr"});
        render(all);
        EXPECT_TRUE(film("a.exr").catcher.empty()) << options[0];
    }
}

TEST_F(CommandLineCatcherTest, BadValuesAreRefused)
{
    const auto expect = [this](const char* option, const char* value, MessageId id) {
        expectRefused(run({"render", "ball.gltf", option, value, "-o", "a.exr"}), 2, id, {.place = option, .value = value});
        EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
    };
    expect("--floor", "low", MessageId::Malformed);
    expect("--floor", "1e10", MessageId::OutOfRange);
    expect("--floor-color", "1,1", MessageId::Malformed);
    expect("--floor-color", "1,1,1.5", MessageId::OutOfRange);
    expect("--floor-roughness", "2", MessageId::OutOfRange);
    expect("--backdrop", "400", MessageId::OutOfRange);
    expect("--catcher-reflections", "yes", MessageId::UnknownName);
    expectRefused(run({"render", "ball.gltf", "--catcher", "floor", "-o", "a.exr"}), 1, MessageId::UnknownName,
                  {.place = "--catcher", .value = "floor"});
}

}  // namespace
}  // namespace glim::test
