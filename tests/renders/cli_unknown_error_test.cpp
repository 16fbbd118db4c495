// Renders whose error nobody can know: they say so, meet no target, and end.
#include "host/job/film_report.hpp"
#include "host/render/film_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <tuple>

namespace glim::test {
namespace {

using nlohmann::json;

struct Rendered {
    GlimRun run;
    std::string statistics;  // JSON as it is written
    json parsed;
};

// A quad under a point light of so many candela, and nothing else.
class UnknownErrorTest : public testing::Test {
protected:
    Rendered render(const std::string& scene, std::vector<std::string> options)
    {
        GlimCall call;
        call.arguments = {"render",     scene,  "-o",      "x.exr",  "--size",        "8x8",
                          "--progress", "none", "--stats", "s.json", "--environment", "none"};
        call.arguments.insert(call.arguments.end(), options.begin(), options.end());
        call.folder = folder_.path();
        GlimRun run = runForMessages(call);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        std::string text = readFileBytes(folder_ / "s.json");
        return {std::move(run), text, json::parse(text)};
    }
    std::string lit(double candela) const
    {
        GltfBuilder builder;
        json primitive = {{"attributes", {{"POSITION", builder.addVec3({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0})}}},
                          {"indices", builder.addIndices({0, 1, 2, 0, 2, 3})}};
        builder.addNode({{"mesh", builder.addMesh(primitive)}});
        builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.2}, {"znear", 0.1}}}});
        builder.addNode({{"camera", 0}, {"translation", {0, 0, 2}}});
        builder.addNode({{"translation", {0, 0, 0.5}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        builder.document["extensionsUsed"] = {"KHR_lights_punctual"};
        builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", candela}}};
        writeText(folder_ / "lit.gltf", builder.toGltf());
        return "lit.gltf";
    }
    std::uint32_t samplesOf() const { return readFilm(folder_ / "x.exr").pixels.front().count; }

    ScratchFolder folder_;
};

void expectNone(const std::string& text)
{
    for (const char* word : {"nan", "NaN", "[0, 0]", "inf,", "inf "}) {
        EXPECT_EQ(text.find(word), std::string::npos) << word << " in " << text;
    }
}

void expectUnknown(const Rendered& rendered, const std::string& because)
{
    EXPECT_TRUE(rendered.parsed.at("estimate").is_null());
    EXPECT_NE(rendered.run.out.find(", error unknown: " + because), std::string::npos) << rendered.run.out;
    expectNone(rendered.run.out + rendered.run.err);
    expectNone(rendered.statistics);
}

const char* const kLarge = "its radiance is so large that float32 does not hold the squares";
const char* const kSmall = "its radiance is so small that float32 does not hold the squares";
const char* const kBlack = "the picture is black";

TEST_F(UnknownErrorTest, OfRadianceBeyondFloat)
{
    expectUnknown(render(lit(1e37), {"--spp", "64"}), kLarge);
    expectUnknown(render(lit(1e-22), {"--spp", "64"}), kSmall);
    EXPECT_GT(render(lit(1e3), {"--spp", "64"}).parsed.at("estimate").at("rmseOfMean"), 0.0);
}

TEST_F(UnknownErrorTest, MeetsNoTargetAndEndsTheRender)
{
    for (const auto& [candela, target, because] :
         {std::tuple(1e22, "--target-rmse=0.1%", kLarge), {1e22, "--target-relmse=1000", kLarge}, {0.0, "--target-rmse=1000%", kBlack}}) {
        const Rendered rendered = render(lit(candela), {target});
        expectUnknown(rendered, because);
        EXPECT_EQ(rendered.parsed.at("stopReason"), "unknown error");
        EXPECT_EQ(samplesOf(), kSamplesOfUnknownError);
        expectSaid(rendered.run, MessageId::TargetUnreachable, {.value = "1024 samples per pixel"});
    }
    const Rendered less = render(lit(0.0), {"--target-rmse", "1%", "--spp", "128"});
    EXPECT_EQ(less.parsed.at("stopReason"), "samples");
    expectUnknown(less, kBlack);
    EXPECT_EQ(render(lit(0.0), {"--target-rmse", "1%", "--adaptive", "neighbours"}).parsed.at("stopReason"), "unknown error");
}

TEST_F(UnknownErrorTest, OfADenoisedPictureToo)
{
    const Rendered rendered = render(lit(0.0), {"--target-rmse", "1000%", "--denoise", "--denoised", "--clamp-indirect", "1"});
    expectUnknown(rendered, kBlack);
    EXPECT_NE(rendered.run.out.find(", denoised: error unknown"), std::string::npos) << rendered.run.out;
    EXPECT_EQ(rendered.parsed.at("stopReason"), "unknown error");
    EXPECT_TRUE(rendered.parsed.at("denoised").at("rmseOfMean").is_null());
    EXPECT_TRUE(rendered.parsed.at("denoised").at("mse95")[1].is_null());
}

// A sequence keeps the pictures that have ended so, and a render that is resumed ends where it did.
TEST_F(UnknownErrorTest, IsTheEndOfTheRenderOnceMore)
{
    const std::string scene = lit(0.0);
    render(scene, {"--target-rmse", "1%", "--checkpoint", "1000s"});
    const std::string bytes = readFileBytes(folder_ / "x.exr");
    EXPECT_EQ(render(scene, {"--target-rmse", "1%", "--resume"}).parsed.at("resumedSamples"), 1024 * 8 * 8);
    EXPECT_EQ(samplesOf(), kSamplesOfUnknownError);
}

}  // namespace
}  // namespace glim::test
