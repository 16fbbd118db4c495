// What the files of a render hold: pixels, layers, attributes and statistics.
#include "host/image/exr.hpp"
#include "host/image/png.hpp"
#include "host/render/film_file.hpp"
#include "tests/support/decode_png.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glim::test {
namespace {

using nlohmann::json;
using Arguments = std::vector<std::string>;

constexpr std::uint32_t kSide = 8;       // pixels
constexpr float kPixel = 10.0F / kSide;  // metres, at the distance of the lamp
constexpr float kDistance = 5.0F;
constexpr float kRadiance[3] = {2.0F, 1.0F, 0.25F};

// A camera of 90 degrees at z = 5 looks at the plane z = 0, of which it sees -5 to 5. A lamp there covers the upper left
// corner: 2.5 pixels wide, 2 pixels high.
std::string lampScene()
{
    GltfBuilder builder;
    const float right = -5.0F + 2.5F * kPixel, bottom = 5.0F - 2.0F * kPixel;
    const std::size_t positions = builder.addVec3({-6, bottom, 0, right, bottom, 0, right, 6, 0, -6, bottom, 0, right, 6, 0, -6, 6, 0});
    builder.append(
        "materials",
        {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}}},
         {"emissiveFactor", {1, 0.5, 0.125}},
         {"extensions",
          {{"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}}, {"KHR_materials_specular", {{"specularFactor", 0}}}}}});
    builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", positions}}}, {"material", 0}})}});
    builder.append("cameras", {{"type", "perspective"},
                               {"name", "wide"},
                               {"perspective", {{"yfov", 1.5707963267948966}, {"aspectRatio", 1.5}, {"znear", 0.01}}}});
    builder.append("cameras",
                   {{"type", "orthographic"}, {"name", "flat"}, {"orthographic", {{"xmag", 5}, {"ymag", 5}, {"znear", 0}, {"zfar", 100}}}});
    builder.addNode({{"camera", 0}, {"translation", {0, 0, kDistance}}});
    builder.addNode({{"camera", 1}, {"translation", {0, 0, 2}}});
    return builder.toGltf();
}

class Workplace {
public:
    Workplace() { writeText(folder_ / "lamp.gltf", lampScene()); }

    // Renders the lamp to x.exr; fails the test unless that succeeds.
    GlimRun render(const Arguments& options) const
    {
        GlimCall call;
        call.arguments = {"render", "lamp.gltf", "-o", "x.exr"};
        call.arguments.insert(call.arguments.end(), options.begin(), options.end());
        call.folder = folder_.path();
        const GlimRun run = runGlim(call);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return run;
    }
    Image image() const { return readExr(folder_ / "x.exr"); }
    std::filesystem::path file(const char* name) const { return folder_ / name; }

private:
    ScratchFolder folder_;
};

// The share of a pixel that the lamp covers; column 2 is cut in half.
float coverage(std::uint32_t x, std::uint32_t y) { return y > 1 || x > 2 ? 0.0F : (x == 2 ? 0.5F : 1.0F); }

TEST(CommandLineTest, RowZeroIsAtTheTopAndAlphaIsCoverage)
{
    const Workplace workplace;
    workplace.render({"--size", "8x8", "--spp", "64", "--bounces", "0"});
    Image image = workplace.image();
    ASSERT_EQ(image.width, kSide);
    ASSERT_EQ(image.height, kSide);
    const char* const letters[] = {"R", "G", "B"};
    for (std::uint32_t y = 0; y < kSide; ++y) {
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const std::size_t i = std::size_t{y} * kSide + x;
            const float alpha = image.channels["A"][i];
            // Not exactly half of the samples hit half a pixel, but exactly the share that alpha says.
            EXPECT_NEAR(alpha, coverage(x, y), x == 2 ? 0.1F : 0.0F) << x << ' ' << y;
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(image.channels[letters[c]][i], kRadiance[c] * alpha, 1e-5F) << x << ' ' << y;
            }
            const float depth = image.channels["depth.Z"][i];
            if (alpha > 0.0F) {
                EXPECT_NEAR(depth, kDistance, 1e-4F) << "along the view axis, not along the ray: " << x << ' ' << y;
                EXPECT_NEAR(image.channels["normal.Z"][i], alpha, 1e-5F);
            } else {
                EXPECT_EQ(depth, std::numeric_limits<float>::infinity()) << x << ' ' << y;
            }
        }
    }
}

TEST(CommandLineTest, AnOutputMayBeAPicture)
{
    const ScratchFolder folder;
    writeText(folder / "lamp.gltf", lampScene());
    const auto run = [&folder](const Arguments& options) {
        GlimCall call;
        call.arguments = {"render", "lamp.gltf", "--size", "8x8", "--spp", "4"};
        call.arguments.insert(call.arguments.end(), options.begin(), options.end());
        call.folder = folder.path();
        return runGlim(call);
    };
    ASSERT_EQ(run({"-o", "film.exr", "--image", "beside.png", "--exposure", "-1"}).exitCode, 0);
    const GlimRun alone = run({"-o", "alone.PNG", "--image", "other.webp", "--exposure", "-1"});
    EXPECT_EQ(alone.exitCode, 0) << alone.err;
    EXPECT_TRUE(contains(alone.out, "alone.PNG: 8x8, 4 samples per pixel")) << alone.out;
    EXPECT_EQ(readFileBytes(folder / "alone.PNG"), readFileBytes(folder / "beside.png"));
    EXPECT_EQ(folder.entries(), 5) << "the scene, the film and three pictures";
    const GlimRun merged = runGlim({"merge", folder / "film.exr", "-o", folder / "merged.png", "--exposure", "-1"});
    EXPECT_EQ(merged.exitCode, 0) << merged.err;
    EXPECT_TRUE(contains(merged.err, "into " + (folder / "merged.png").string())) << merged.err;
    EXPECT_EQ(readFileBytes(folder / "merged.png"), readFileBytes(folder / "beside.png"));
    EXPECT_EQ(folder.entries(), 6);
    EXPECT_TRUE(contains(alone.out, "RMSE at most ")) << "of four samples: " << alone.out;
    EXPECT_EQ(run({"-o", "same.png", "--image", "same.png"}).exitCode, 2);
    EXPECT_EQ(run({"-o", "none/x.png"}).exitCode, 1);
    for (const Arguments& kept : {Arguments{"--resume"}, Arguments{"--checkpoint", "5m"}}) {
        Arguments options{"-o", "x.png"};
        options.insert(options.end(), kept.begin(), kept.end());
        const GlimRun refused = run(options);
        EXPECT_EQ(refused.exitCode, 2);
        EXPECT_TRUE(contains(refused.err, "--output FILE.exr")) << refused.err;
    }
    EXPECT_EQ(folder.entries(), 6);
}

TEST(CommandLineTest, APictureAloneIsDenoisedAndSaysBothErrors)
{
    const ScratchFolder folder;
    const auto draw = [&folder](const std::string& output, const Arguments& options) {
        GlimCall call;
        call.arguments = {"render", sceneFile("cornell.gltf"), "--size", "24x24", "-o", output};
        call.arguments.insert(call.arguments.end(), options.begin(), options.end());
        call.folder = folder.path();
        const GlimRun run = runGlim(call);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return run.out;
    };
    const std::string said = draw("alone.png", {});
    EXPECT_TRUE(contains(said, "estimated relMSE") && contains(said, "denoised: measured RMSE") && contains(said, "(noisy ")) << said;
    EXPECT_FALSE(contains(draw("noisy.png", {"--no-denoise"}), "denoised"));
    EXPECT_FALSE(contains(draw("film.exr", {"--image", "ofFilm.png"}), "denoised"));
    draw("denoised.exr", {"--denoise", "--image", "ofDenoised.png"});
    EXPECT_EQ(readFileBytes(folder / "alone.png"), readFileBytes(folder / "ofDenoised.png"));
    EXPECT_EQ(readFileBytes(folder / "noisy.png"), readFileBytes(folder / "ofFilm.png"));
    EXPECT_NE(readFileBytes(folder / "alone.png"), readFileBytes(folder / "noisy.png"));
}

TEST(CommandLineTest, ExposureIsAppliedToThePngOnly)
{
    const Workplace workplace;
    const Arguments size{"--size", "8x8", "--spp", "32", "--bounces", "0", "--png", "x.png"};
    workplace.render(size);
    const Image plain = workplace.image();
    const std::vector<Rgb> plainPng = decodePng(workplace.file("x.png"));
    Arguments darker = size;
    darker.insert(darker.end(), {"--exposure", "-2"});
    workplace.render(darker);
    const Image exposed = workplace.image();
    const std::vector<Rgb> exposedPng = decodePng(workplace.file("x.png"));
    EXPECT_EQ(exposed.channels, plain.channels);
    ASSERT_EQ(plainPng.size(), std::size_t{kSide * kSide});
    EXPECT_EQ(plainPng[0], (Rgb{255, 255, srgbByte(0.25)}));
    EXPECT_EQ(exposedPng[0], (Rgb{srgbByte(0.5), srgbByte(0.25), srgbByte(0.0625)}));
    EXPECT_EQ(plainPng.back(), (Rgb{0, 0, 0}));
}

TEST(CommandLineTest, TheEnvironmentFillsWhatIsNotCovered)
{
    const Workplace workplace;
    workplace.render({"--size", "8x8", "--spp", "32", "--environment", "0.5,0.25,3"});
    const Image image = workplace.image();
    EXPECT_EQ(image.channels.at("R").back(), 0.5F);
    EXPECT_EQ(image.channels.at("G").back(), 0.25F);
    EXPECT_EQ(image.channels.at("B").back(), 3.0F);
    EXPECT_EQ(image.channels.at("A").back(), 0.0F);
    EXPECT_EQ(image.channels.at("R").front(), kRadiance[0]);
}

TEST(CommandLineTest, CamerasByNameAndIndex)
{
    const Workplace workplace;
    const auto depthThrough = [&](const Arguments& options) {
        Arguments arguments{"--size", "8x8", "--spp", "1", "--bounces", "0"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        workplace.render(arguments);
        return workplace.image().channels.at("depth.Z").front();
    };
    EXPECT_NEAR(depthThrough({}), kDistance, 1e-4F);
    EXPECT_NEAR(depthThrough({"--camera", "wide"}), kDistance, 1e-4F);
    EXPECT_NEAR(depthThrough({"--camera", "1"}), 2.0F, 1e-4F);
    EXPECT_NEAR(depthThrough({"--camera", "flat"}), 2.0F, 1e-4F);
}

TEST(CommandLineTest, DefaultsAreWhatTheHelpSays)
{
    const Workplace workplace;
    workplace.render({"--spp", "1", "--bounces", "0"});
    const Image large = workplace.image();
    EXPECT_EQ(large.width, 768U);
    EXPECT_EQ(large.height, 512U);
    workplace.render({"--size", "4x4"});
    const Image image = workplace.image();
    EXPECT_EQ(std::get<std::string>(image.attributes.at("glim:samples")), "0:64");
    EXPECT_EQ(std::get<double>(image.attributes.at("glim:seed")), 0.0);
    const std::string settings = std::get<std::string>(image.attributes.at("glim:settings"));
    EXPECT_NE((settings + " ").find("bounces=64 "), std::string::npos) << settings;
    EXPECT_NE((settings + " ").find("sampler=sobol "), std::string::npos) << settings;
    EXPECT_EQ(settings.find("clamp"), std::string::npos) << settings;
}

TEST(CommandLineTest, LayersAndAttributesOfTheExr)
{
    const Workplace workplace;
    workplace.render({"--size", "4x4", "--samples", "32:96", "--seed", "7"});
    const Image image = workplace.image();
    for (const char* name : {"R", "G", "B", "A", "variance.R", "variance.G", "variance.B", "albedo.R", "albedo.G", "albedo.B", "normal.X",
                             "normal.Y", "normal.Z", "depth.Z", "squares.R", "squares.G", "squares.B"}) {
        EXPECT_EQ(image.channels.count(name), 1U) << name;
    }
    EXPECT_EQ(image.counts.at("count.X"), std::vector<std::uint32_t>(16, 64));
    EXPECT_EQ(image.counts.at("blocks.X"), std::vector<std::uint32_t>(16, 2));
    const auto text = [&](const char* name) { return std::get<std::string>(image.attributes.at(name)); };
    EXPECT_EQ(text("software").rfind("glim ", 0), 0U);
    EXPECT_EQ(text("glim:sceneFile"), "lamp.gltf");
    EXPECT_EQ(text("glim:samples"), "32:96");
    EXPECT_NE(text("glim:scene"), "");
    EXPECT_NE(text("glim:device"), "");
    EXPECT_EQ(std::get<double>(image.attributes.at("glim:seed")), 7.0);
    EXPECT_GT(std::get<double>(image.attributes.at("glim:seconds")), 0.0);
}

TEST(CommandLineTest, StatisticsAreCompleteAndSane)
{
    const ScratchFolder folder;
    const std::filesystem::path stats = folder / "s.json";
    const GlimRun run = runGlim({"render", sceneFile("cornell.gltf"), "-o", (folder / "x.exr").string(), "--size", "16x8", "--spp", "64",
                                 "--schedule", "persistent", "--stats", stats.string()});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const json s = json::parse(readFileBytes(stats));
    EXPECT_EQ(s.at("samples"), 16 * 8 * 64);
    EXPECT_EQ(s.at("size"), json({16, 8}));
    EXPECT_EQ(s.at("sampleRange"), json({0, 64}));
    EXPECT_EQ(s.at("stopReason"), "samples");
    for (const char* stage : {"load", "build", "upload", "compile", "render", "write"}) {
        EXPECT_GT(s.at("seconds").at(stage), 0.0) << stage;
        EXPECT_LT(s.at("seconds").at(stage), 100.0) << stage;
    }
    const double upload = s.at("seconds").at("upload"), compile = s.at("seconds").at("compile"), first = s.at("seconds").at("firstPass");
    EXPECT_GT(compile, upload) << "making the kernels' pipelines is part of their compilation";
    EXPECT_GT(first, upload + compile);
    EXPECT_LT(first, upload + compile + s.at("seconds").at("render").get<double>());
    EXPECT_GE(s.at("rays").at("closest"), 16 * 8 * 64);
    EXPECT_GT(s.at("rays").at("shadow"), 0);
    EXPECT_EQ(s.at("rays").at("total"), s.at("rays").at("closest").get<int>() + s.at("rays").at("shadow").get<int>());
    const double renderSeconds = s.at("seconds").at("render");
    EXPECT_NEAR(s.at("raysPerSecond").get<double>() * renderSeconds, s.at("rays").at("total").get<double>(), 1.0);
    double kernelSeconds = 0.0;
    for (const char* kernel : {"generate_rays", "trace_paths", "accumulate"}) {
        EXPECT_GT(s.at("kernels").at(kernel).at("dispatches"), 0) << kernel;
        kernelSeconds += s.at("kernels").at(kernel).at("seconds").get<double>();
    }
    EXPECT_GT(kernelSeconds, 0.0);
    EXPECT_LT(kernelSeconds, renderSeconds);
    EXPECT_GT(s.at("peakMemory").at("host"), 1 << 20);
    EXPECT_GT(s.at("peakMemory").at("device"), 1 << 20);
    EXPECT_EQ(s.at("nonFinite").at("count"), 0);
    EXPECT_EQ(s.at("schedule"), "persistent");  // as asked: what auto takes depends on the device
    EXPECT_EQ(s.at("loopCapHits"), 0);
    EXPECT_EQ(s.at("overflows"), 0);
    EXPECT_NE(s.at("device").at("name"), "");
    EXPECT_GT(s.at("estimate").at("relmse"), 0.0);
    EXPECT_LT(s.at("estimate").at("relmse"), 1.0);
    EXPECT_GT(s.at("estimate").at("rmse"), 0.0);
    EXPECT_TRUE(s.at("clampIndirect").is_null());
}

TEST(CommandLineTest, ClampingSaysWhatItTook)
{
    const ScratchFolder folder;
    const std::string exr = (folder / "x.exr").string(), stats = (folder / "s.json").string();
    const Arguments plain{"render", sceneFile("cornell.gltf"), "-o", exr, "--size", "16x16", "--spp", "32", "--stats", stats};
    const auto meanOf = [&] {
        double sum = 0.0;
        for (const PixelMoments& pixel : readFilm(exr).pixels) {
            sum += static_cast<double>(pixel.mean.r + pixel.mean.g + pixel.mean.b) / 3.0;
        }
        return sum / (16 * 16);
    };
    ASSERT_EQ(runGlim(plain).exitCode, 0);
    const double whole = meanOf();
    Arguments clamped = plain;
    clamped.insert(clamped.end(), {"--clamp-indirect", "0.05"});
    const GlimRun run = runGlim(clamped);
    ASSERT_EQ(run.exitCode, 0);
    EXPECT_NE(run.err.find("--clamp-indirect removed "), std::string::npos) << run.err;
    const json energy = json::parse(readFileBytes(stats)).at("clampIndirect");
    EXPECT_GT(energy.at("removedShare"), 0.01);
    EXPECT_NEAR(meanOf() + energy.at("removedMeanRadiance").get<double>(), whole, 1e-3 * whole);
}

}  // namespace
}  // namespace glim::test
