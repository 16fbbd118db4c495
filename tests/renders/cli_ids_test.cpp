// render --ids: beside the picture, whose bits stay, and whenever a picture is written.
#include "host/image/exr.hpp"
#include "host/render/film_file.hpp"
#include "host/scene/scene.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>

namespace glim::test {
namespace {

using nlohmann::json;

class IdsTest : public testing::Test {
protected:
    GlimRun render(const std::vector<std::string>& options, int signal = 0) const
    {
        GlimCall call;
        call.arguments = {"render", sceneFile("cornell_spheres.gltf"), "-o", "x.exr"};
        call.arguments.insert(call.arguments.end(), options.begin(), options.end());
        call.folder = folder_.path();
        call.signal = signal;
        call.signalWhen = signal == 0 ? nullptr : hasLine;
        return runGlim(call);
    }
    Film film() const { return readFilm(folder_ / "x.exr"); }
    Image ids() const { return readExr(folder_ / "i.exr"); }
    json statistics() const { return json::parse(readFileBytes(folder_ / "s.json")); }

    ScratchFolder folder_;
};

TEST_F(IdsTest, ChangeNoBitOfThePicture)
{
    ASSERT_EQ(render({"--size", "24x24", "--spp", "8", "--stats", "s.json"}).exitCode, 0);
    EXPECT_TRUE(statistics().at("seconds").at("ids").is_null());
    const Film plain = film();
    ASSERT_EQ(render({"--size", "24x24", "--spp", "8", "--stats", "s.json", "--ids", "i.exr"}).exitCode, 0);
    EXPECT_TRUE(sameBits(plain, film()));
    EXPECT_GT(statistics().at("seconds").at("ids"), 0.0);
    const Image image = ids();
    EXPECT_EQ(image.width, 24U);
    EXPECT_EQ(image.channels.size(), 3U * 12U);
    EXPECT_EQ(image.counts.size(), 3U);
    EXPECT_EQ(std::get<std::string>(image.attributes.at("cryptomatte/3ae39a5/name")), "CryptoObject");
    EXPECT_EQ(std::get<std::string>(image.attributes.at("cryptomatte/f42029d/name")), "CryptoAsset");
    EXPECT_EQ(std::get<std::string>(image.attributes.at("cryptomatte/be359d6/name")), "CryptoMaterial");
}

// More pixels than a band has. Each sees the inside of the box.
TEST_F(IdsTest, HaveAllRowsOfALargePicture)
{
    ASSERT_EQ(render({"--size", "300x500", "--spp", "1", "--bounces", "0", "--ids", "i.exr"}).exitCode, 0);
    const Image image = ids();
    const std::vector<float>& coverage = image.channels.at("CryptoObject00.G");
    const Film picture = film();
    ASSERT_EQ(coverage.size(), 150000U);
    for (std::size_t i = 0; i < coverage.size(); ++i) {
        ASSERT_EQ(coverage[i], picture.pixels[i].alpha) << i;
    }
}

TEST_F(IdsTest, GoWithOtherWaysToSample)
{
    for (const std::vector<std::string>& options : {std::vector<std::string>{"--samples", "5:9"},
                                                    {"--adaptive", "neighbours", "--spp", "128"},
                                                    {"--view", "normal"},
                                                    {"--adaptive", "course", "--max-spp", "64", "--bounces", "1"},
                                                    {"--accelerator", "none", "--spp", "1"}}) {
        std::vector<std::string> all{"--size", "8x8", "--ids", "i.exr"};
        all.insert(all.end(), options.begin(), options.end());
        const GlimRun run = render(all);
        ASSERT_EQ(run.exitCode, 0) << run.err;
        EXPECT_EQ(std::ranges::count(ids().counts.at("node.X"), kNoIndex), 0) << options[0];
    }
}

TEST_F(IdsTest, AreWrittenForAPictureThatASignalEnded)
{
    const GlimRun run = render({"--size", "60x60", "--spp", "2000000", "--progress", "json", "--ids", "i.exr"}, SIGINT);
    EXPECT_EQ(run.exitCode, 130) << run.err;
    const Image image = ids();
    const Film picture = film();
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const bool shows = image.counts.at("node.X")[i] != kNoIndex;
        EXPECT_EQ(shows, picture.pixels[i].count > 0) << i;
    }
}

}  // namespace
}  // namespace glim::test
