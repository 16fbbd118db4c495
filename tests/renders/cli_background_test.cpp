// Pictures with the environment hidden: alpha where no surface is, whatever writes them.
#include "host/image/decode_image.hpp"
#include "host/image/srgb.hpp"
#include "host/render/film_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim::test {
namespace {

class HiddenBackgroundTest : public ::testing::Test {
protected:
    // A grey ball in the middle of the picture.
    void SetUp() override
    {
        GltfBuilder builder;
        builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.75, 1}}, {"metallicFactor", 0}}}});
        builder.addNode({{"extras", {{"sphere", {{"radius", 1}, {"material", 0}}}}}});
        builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.1}}}});
        builder.addNode({{"camera", 0}, {"translation", {0, 0, 5}}});
        writeText(folder_ / "ball.gltf", builder.toGltf());
    }
    GlimRun run(const std::vector<std::string>& arguments) const
    {
        GlimCall call;
        call.arguments = arguments;
        call.folder = folder_.path();
        GlimRun done = runForMessages(call);
        EXPECT_EQ(done.exitCode, 0) << done.err;
        return done;
    }
    GlimRun render(const std::vector<std::string>& options) const
    {
        std::vector<std::string> arguments{"render", "ball.gltf", "--size", "24x20"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run(arguments);
    }
    DecodedImage decoded(const char* name) const
    {
        const std::string bytes = readFileBytes(folder_ / name);
        DecodedImage image = decodeImage({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
        EXPECT_EQ(image.rgba8.size(), std::size_t{4} * image.width * image.height) << name;
        return image;
    }
    Film film(const char* name) const { return readFilm(folder_ / name); }
    // That the picture's alpha is the film's, and that both have pixels without a surface, with one and with a part of one.
    static void expectCoverage(const DecodedImage& image, const Film& film)
    {
        EXPECT_TRUE(image.hasAlpha);
        std::size_t empty = 0, full = 0;
        for (std::size_t i = 0; i < film.pixels.size(); ++i) {
            const int alpha = image.rgba8[4 * i + 3];
            EXPECT_EQ(alpha, std::lround(255.0F * film.pixels[i].alpha)) << i;
            empty += alpha == 0 ? 1U : 0U;
            full += alpha == 255 ? 1U : 0U;
        }
        EXPECT_GT(empty, 100U);
        EXPECT_GT(full, 100U);
        EXPECT_GT(film.pixels.size() - empty - full, 20U);
    }

    ScratchFolder folder_;
    const std::vector<std::string> hidden_{"--environment", "0.2,0.5,0.8", "--environment-background", "off"};
    std::vector<std::string> hidden(std::vector<std::string> more) const
    {
        more.insert(more.begin(), hidden_.begin(), hidden_.end());
        return more;
    }
};

// Over the colour of the environment, in linear light, the picture is the one in which the environment shows: its paths are the same.
TEST_F(HiddenBackgroundTest, OverABackgroundThePictureIsTheRenderBeforeIt)
{
    const glm::dvec3 background(0.2, 0.5, 0.8);
    render({"--environment", "0.2,0.5,0.8", "--spp", "16", "-o", "shown.exr", "--image", "shown.png"});
    render(hidden({"--spp", "16", "-o", "hidden.exr", "--image", "hidden.png", "--image", "hidden.webp"}));
    EXPECT_FALSE(decoded("shown.png").hasAlpha);
    const DecodedImage png = decoded("hidden.png");
    expectCoverage(png, film("hidden.exr"));
    EXPECT_EQ(decoded("hidden.webp").rgba8, png.rgba8);
    const Film shown = film("shown.exr");
    for (std::size_t i = 0; i < shown.pixels.size(); ++i) {
        const std::uint8_t* pixel = &png.rgba8[4 * i];
        const double alpha = pixel[3] / 255.0;
        for (int c = 0; c < 3; ++c) {
            const double color = linearFromSrgb(pixel[c] / 255.0), over = alpha * color + (1.0 - alpha) * background[c];
            // Half a step of alpha, and of the colour, whose transfer function is nowhere steeper than 2.3.
            const double rounding = 0.5 / 255.0 * (std::abs(color - background[c]) + 2.3 * alpha) + 1e-4;
            EXPECT_NEAR(over, static_cast<double>(shown.pixels[i].mean[c]), rounding) << i << ", channel " << c;
            EXPECT_TRUE(alpha > 0.0 || pixel[c] == 0) << "transparent pixels are black";
        }
    }
}

TEST_F(HiddenBackgroundTest, AJpegIsOpaqueAndSaysWhatItLoses)
{
    const GlimRun lost = render(hidden({"--spp", "2", "-o", "a.jpg"}));
    expectSaid(lost, MessageId::AlphaLost, {.file = "a.jpg", .expected = "PNG or WebP"});
    EXPECT_FALSE(decoded("a.jpg").hasAlpha);
    EXPECT_EQ(decoded("a.jpg").rgba8[0], 0);
    EXPECT_FALSE(hasSaid(render(hidden({"--spp", "2", "-o", "a.png"})), MessageId::AlphaLost));
    EXPECT_FALSE(hasSaid(render({"--environment", "1,1,1", "--spp", "2", "-o", "a.jpg"}), MessageId::AlphaLost));
    EXPECT_FALSE(
        hasSaid(render(hidden({"--spp", "2", "--look-from", "0,0,1.1", "--look-at", "0,0,0", "-o", "a.jpg"})), MessageId::AlphaLost))
        << "the ball fills it";
}

// A scene without an environment has alpha if it is asked for, too.
TEST_F(HiddenBackgroundTest, DependsOnTheOptionAlone)
{
    for (const char* background : {"on", "off"}) {
        render({"--sun", "30,40,3", "--environment", "none", "--environment-background", background, "--spp", "2", "-o", "a.png"});
        EXPECT_EQ(decoded("a.png").hasAlpha, background == std::string("off"));
    }
}

TEST_F(HiddenBackgroundTest, MergedFilmsHaveIt)
{
    render(hidden({"--samples", "0:512", "-o", "all.exr", "--image", "all.png"}));
    render(hidden({"--samples", "0:256", "-o", "a.exr"}));
    render(hidden({"--samples", "256:512", "-o", "b.exr"}));
    run({"merge", "b.exr", "a.exr", "-o", "ab.exr", "--image", "ab.png"});
    EXPECT_EQ(readFileBytes(folder_ / "ab.png"), readFileBytes(folder_ / "all.png"));
    EXPECT_FALSE(film("ab.exr").showsBackground);
    EXPECT_EQ(computeDigest(film("ab.exr")), computeDigest(film("all.exr")));
}

TEST_F(HiddenBackgroundTest, DenoisedPicturesHaveIt)
{
    render(hidden({"--spp", "64", "--denoise", "-o", "a.exr", "--image", "a.png"}));
    render(hidden({"--spp", "64", "--no-denoise", "-o", "noisy.png"}));
    expectCoverage(decoded("a.png"), film("a.exr"));
    EXPECT_NE(decoded("a.png").rgba8, decoded("noisy.png").rgba8);
}

// The second call keeps the films and draws their pictures anew.
TEST_F(HiddenBackgroundTest, SequencesHaveIt)
{
    const std::vector<std::string> words = hidden({"--turntable", "2", "--spp", "4", "-o", "a#.exr", "--image", "a#.png"});
    render(words);
    for (const char* name : {"a0", "a1"}) {
        expectCoverage(decoded((std::string(name) + ".png").c_str()), film((std::string(name) + ".exr").c_str()));
    }
    const std::string before = readFileBytes(folder_ / "a1.png");
    std::filesystem::remove(folder_ / "a1.png");
    EXPECT_TRUE(contains(render(words).out, "is whole and was kept"));
    EXPECT_EQ(readFileBytes(folder_ / "a1.png"), before);
}

}  // namespace
}  // namespace glim::test
