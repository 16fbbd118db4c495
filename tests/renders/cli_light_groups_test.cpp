// --light-group from the command line, and --light of glim merge.
#include "host/image/decode_image.hpp"
#include "host/image/exr.hpp"
#include "host/render/film_file.hpp"
#include "host/render/regroup.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace glim::test {
namespace {

class CommandLineLightGroupsTest : public ::testing::Test {
protected:
    // A ball under a lamp.
    void SetUp() override
    {
        GltfBuilder builder;
        builder.append("materials", {{"name", "ball"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.75, 1}}}}});
        builder.append("materials", {{"name", "lamp"}, {"emissiveFactor", {1, 0.5, 0.25}}});
        builder.addNode({{"extras", {{"sphere", {{"radius", 1}, {"material", 0}}}}}});
        builder.addNode({{"translation", {2, 2, 1}}, {"extras", {{"sphere", {{"radius", 0.5}, {"material", 1}}}}}});
        writeText(folder_ / "a.gltf", builder.toGltf());
    }
    GlimRun run(const std::vector<std::string>& arguments) const
    {
        GlimCall call;
        call.arguments = arguments;
        call.folder = folder_.path();
        return runForMessages(call);
    }
    GlimRun tryRender(const std::vector<std::string>& options) const
    {
        std::vector<std::string> arguments{"render",        "a.gltf",      "--size",      "24x20", "--sun",     "40,50,3",
                                           "--environment", "0.3,0.3,0.4", "--look-from", "1,2,6", "--look-at", "0.5,0.5,0"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run(arguments);
    }
    GlimRun render(const std::vector<std::string>& options) const
    {
        GlimRun done = tryRender(options);
        EXPECT_EQ(done.exitCode, 0) << done.err;
        return done;
    }
    Film film(const char* name) const { return readFilm(folder_ / name); }

    ScratchFolder folder_;
};

const std::vector<std::string> kGroups{"--light-group", "key=lamp", "--light-group", "outside=sun,environment"};

std::vector<std::string> with(std::vector<std::string> options)
{
    options.insert(options.end(), kGroups.begin(), kGroups.end());
    return options;
}

TEST_F(CommandLineLightGroupsTest, FilmsAndLayersHaveEachLight)
{
    const GlimRun done = render(with({"--spp", "64", "-o", "a.exr", "--layers", "l.exr"}));
    expectSaid(done, MessageId::GroupMemory);
    const Film film = this->film("a.exr");
    EXPECT_EQ(getLightGroups(film), (std::vector<std::string>{"key", "outside"}));
    const Image stored = readExr(folder_ / "a.exr"), layers = readExr(folder_ / "l.exr");
    double key = 0.0, outside = 0.0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const float sum = stored.channels.at("lights.key.R")[i] + stored.channels.at("lights.outside.R")[i];
        EXPECT_NEAR(sum, stored.channels.at("R")[i], 1e-5F * sum);
        EXPECT_NEAR(layers.channels.at("lights.key.R")[i], stored.channels.at("lights.key.R")[i], 1e-3F * sum);
        key += static_cast<double>(stored.channels.at("lights.key.R")[i]);
        outside += static_cast<double>(stored.channels.at("lights.outside.R")[i]);
    }
    EXPECT_GT(key, 1.0);
    EXPECT_GT(outside, 1.0);
    render({"--spp", "64", "-o", "plain.exr"});
    const Film plain = this->film("plain.exr");
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        EXPECT_EQ(film.pixels[i].mean, plain.pixels[i].mean) << "the picture has the same bits";
    }
}

TEST_F(CommandLineLightGroupsTest, LightsAreChangedAfterwards)
{
    render(with({"--spp", "64", "-o", "a.exr"}));
    const auto merge = [this](std::vector<std::string> options) {
        options.insert(options.begin(), {"merge", "a.exr"});
        const GlimRun done = run(options);
        EXPECT_EQ(done.exitCode, 0) << done.err;
        return done;
    };
    merge({"-o", "b.exr", "--image", "b.png", "--light", "key=2", "--light", "outside=0,0.5,1"});
    const Film weighed = film("b.exr"), expected = regroup(film("a.exr"), {glm::vec3(2.0F), {0.0F, 0.5F, 1.0F}});
    EXPECT_EQ(computePixelsDigest(weighed), computePixelsDigest(expected));
    EXPECT_TRUE(getLightGroups(weighed).empty());
    EXPECT_TRUE(std::filesystem::exists(folder_ / "b.png"));
    // A render with such lights agrees up to its noise, which is independent.
    const GlimRun alone = run({"render", "a.gltf", "--size", "24x20", "--environment", "none", "--look-from", "1,2,6", "--look-at",
                               "0.5,0.5,0", "--spp", "64", "--seed", "5", "-o", "c.exr"});
    EXPECT_EQ(alone.exitCode, 0) << alone.err;
    merge({"-o", "d.exr", "--light", "outside=0"});
    double a = 0.0, b = 0.0, variance = 0.0;
    const Film dark = film("d.exr"), lamp = film("c.exr");
    for (std::size_t i = 0; i < dark.pixels.size(); ++i) {
        a += static_cast<double>(dark.pixels[i].mean.r);
        b += static_cast<double>(lamp.pixels[i].mean.r);
        variance += static_cast<double>(computeVarianceOfMean(dark.pixels[i]).r + computeVarianceOfMean(lamp.pixels[i]).r);
    }
    EXPECT_LE(std::abs(a - b), 3.3 * std::sqrt(variance)) << "by the stated error of both";
    EXPECT_GT(a, 10.0 * std::sqrt(variance));
    expectRefused(run({"merge", "a.exr", "-o", "e.exr", "--light", "sky=1"}), 1, MessageId::UnknownName, {.file = "a.exr", .value = "sky"});
    expectRefused(run({"merge", "b.exr", "-o", "e.exr", "--light", "key=1"}), 1, MessageId::UnknownName, {.file = "b.exr"});
    expectRefused(run({"merge", "a.exr", "b.exr", "-o", "e.exr"}), 1, MessageId::Mismatch);
}

TEST_F(CommandLineLightGroupsTest, FilmsResumeAndMergeToTheBitsOfOneRun)
{
    render(with({"--spp", "512", "-o", "all.exr"}));
    const std::string digest = computeDigest(film("all.exr"));
    render(with({"--spp", "300", "-o", "some.exr", "--checkpoint", "1h"}));
    render(with({"--spp", "512", "-o", "some.exr", "--resume"}));
    EXPECT_EQ(computeDigest(film("some.exr")), digest);
    render(with({"--samples", "0:256", "-o", "a.exr"}));
    render(with({"--samples", "256:512", "-o", "b.exr"}));
    EXPECT_EQ(run({"merge", "b.exr", "a.exr", "-o", "ab.exr"}).exitCode, 0);
    EXPECT_EQ(computeDigest(film("ab.exr")), digest);
    for (const char* rows : {"0:7", "7:20"}) {
        render(with({"--rows", rows, "--spp", "512", "-o", std::string("rows") + rows[0] + ".exr"}));
    }
    EXPECT_EQ(run({"merge", "rows0.exr", "rows7.exr", "-o", "rows.exr"}).exitCode, 0);
    EXPECT_EQ(computeDigest(film("rows.exr")), digest);
    const GlimRun refused = tryRender({"--spp", "512", "-o", "all.exr", "--resume"});
    EXPECT_EQ(refused.exitCode, 1);
    expectSaid(refused, MessageId::Mismatch, {.place = "choice of light groups", .value = "key,outside", .expected = "none"});
}

TEST_F(CommandLineLightGroupsTest, OtherViewsHaveNone)
{
    render(with({"--spp", "4", "--view", "depth", "-o", "a.exr"}));
    EXPECT_TRUE(getLightGroups(film("a.exr")).empty());
    render({"--spp", "4", "--light-group", "each", "-o", "b.exr"});
    EXPECT_EQ(getLightGroups(film("b.exr")), (std::vector<std::string>{"sun", "lamp", "environment"}));
}

TEST_F(CommandLineLightGroupsTest, BadValuesAreRefused)
{
    const auto expect = [this](const char* value, int code, MessageId id) {
        expectRefused(tryRender({"--light-group", value, "-o", "bad.exr"}), code, id, {.place = "--light-group"});
        EXPECT_FALSE(std::filesystem::exists(folder_ / "bad.exr"));
    };
    expect("key", 2, MessageId::Malformed);
    expect("=lamp", 2, MessageId::Malformed);
    expect("a.b=lamp", 2, MessageId::Malformed);
    expect("key=", 2, MessageId::Malformed);
    expect("key=lamp,,sun", 2, MessageId::Malformed);
    expect("others=lamp", 2, MessageId::OutOfRange);
    expect("key=nothing", 1, MessageId::UnknownName);
    expectRefused(tryRender({"--light-group", "a=lamp", "--light-group", "a=sun", "-o", "bad.exr"}), 2, MessageId::OutOfRange);
    expectRefused(tryRender({"--light-group", "a=lamp", "--light-group", "b=la*", "-o", "bad.exr"}), 1, MessageId::Duplicate);
    render(with({"--spp", "4", "-o", "a.exr"}));
    for (const char* value : {"key", "key=", "key=-1", "key=1,2", "=1", "key=nan"}) {
        const GlimRun refused = run({"merge", "a.exr", "-o", "b.exr", "--light", value});
        EXPECT_EQ(refused.exitCode, 2) << value;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "b.exr"));
    }
}

}  // namespace
}  // namespace glim::test
