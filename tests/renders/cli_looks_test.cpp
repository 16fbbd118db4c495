// What the program says of materials, textures, environments and exposure, and how it refuses what it cannot use.
#include "host/image/decode_image.hpp"
#include "host/image/exr.hpp"
#include "shaders/shared/limits.h"
#include "tests/support/encode_images.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <numeric>
#include <regex>
#include <set>

namespace glim::test {
namespace {

using nlohmann::json;
using Arguments = std::vector<std::string>;
using Id = MessageId;

class LooksTest : public ::testing::Test {
protected:
    GlimRun run(const Arguments& arguments) const
    {
        GlimCall call;
        call.arguments = arguments;
        call.folder = folder_.path();
        return runForMessages(call);
    }
    GlimRun render(const Arguments& options) const
    {
        Arguments arguments{"render", "scene.gltf", "-o", "x.exr", "--size", "8x8", "--spp", "2"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run(arguments);
    }
    json jsonIn(const char* name) const { return json::parse(readFileBytes(folder_ / name)); }

    // A coated triangle that fills the view, with a texture of 4x2 texels.
    void writeCoated() const
    {
        GltfBuilder builder;
        const std::size_t mesh = builder.addTriangleMesh();
        json& primitive = builder.document["meshes"][mesh]["primitives"][0];
        primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor(toBytes(std::vector<float>(6, 0.125F)), kFloat, "VEC2", 3);
        primitive["material"] = 0;
        Bytes texels;
        for (int i = 0; i < 8; ++i) {
            texels.insert(texels.end(), {static_cast<unsigned char>(i % 4 == 0 ? 255 : 0), 255, 255});
        }
        const Bytes png = encodePng(4, 2, texels);
        writeText(folder_ / "wood.png", {png.begin(), png.end()});
        builder.append("images", {{"uri", "wood.png"}});
        builder.append("samplers", {{"magFilter", 9728}});
        builder.append("textures", {{"source", 0}, {"sampler", 0}});
        builder.append("materials", {{"name", "paint"},
                                     {"pbrMetallicRoughness",
                                      {{"baseColorFactor", {0.5, 0.25, 0.125, 1}},
                                       {"metallicFactor", 0.25},
                                       {"roughnessFactor", 0.5},
                                       {"baseColorTexture", {{"index", 0}}}}},
                                     {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.75}}}}}});
        builder.addNode({{"mesh", mesh}});
        builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.1}, {"znear", 0.1}}}});
        builder.addNode({{"camera", 0}, {"translation", {0.25, 0.25, 2}}});
        writeText(folder_ / "scene.gltf", builder.toGltf());
    }
    // A ball of glass that absorbs red, with a camera before it.
    void writeBall() const
    {
        GltfBuilder builder;
        builder.append(
            "materials",
            {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
             {"extensions",
              {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
               {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 1}, {"attenuationColor", {0.5, 1, 1}}}}}}});
        builder.addNode({{"extras", {{"sphere", {{"radius", 1}, {"material", 0}}}}}});
        builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.1}, {"znear", 0.1}}}});
        builder.addNode({{"camera", 0}, {"translation", {0, 0, 5}}});
        writeText(folder_ / "scene.gltf", builder.toGltf());
    }

    ScratchFolder folder_;
};

TEST_F(LooksTest, InspectListsLobesTexturesEnvironmentAndMedia)
{
    writeCoated();
    const json coated = json::parse(run({"inspect", "scene.gltf", "--json"}).out);
    EXPECT_EQ(coated.at("lobes"), json({{"glTF", 1}, {"clearcoat", 1}}));
    EXPECT_EQ(coated.at("textures"), json::array({{{"name", "images[0] (\"wood.png\")"}, {"width", 4}, {"height", 2}, {"bytes", 32}}}));
    EXPECT_EQ(coated.at("environment").at("source"), "studio");
    EXPECT_EQ(coated.at("environment").at("map").at("width"), 1024);
    EXPECT_EQ(coated.at("textureBytes"), coated.at("environment").at("map").at("bytes").get<int>() + 32);
    const std::string text = run({"inspect", "scene.gltf"}).out;
    for (const char* line :
         {"  lobes: glTF 1, clearcoat 1\n", "  texture images[0] (\"wood.png\"), 4x2, ", "  environment: studio, 1024x512, 12 MiB\n"}) {
        EXPECT_TRUE(contains(text, line)) << text << "lacks: " << line;
    }
    writeBall();
    const json ball = json::parse(run({"inspect", "scene.gltf", "--json"}).out);
    EXPECT_EQ(ball.at("lobes"), json({{"glass", 1}}));
    ASSERT_EQ(ball.at("media").size(), 1U);
    EXPECT_EQ(ball.at("media")[0].at("ior"), 1.5);
    EXPECT_NEAR(ball.at("media")[0].at("absorption")[0], std::log(2.0), 1e-6);
    EXPECT_EQ(ball.at("media")[0].at("absorption")[1], 0);
    EXPECT_TRUE(contains(run({"inspect", "scene.gltf"}).out, "  medium 1: index 1.5, absorption (0.693, 0, 0) per metre\n"));
}

TEST_F(LooksTest, InspectSaysWhatBecomesOfExtensions)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    builder.document["extensionsUsed"] = {"KHR_xmp_json_ld", "KHR_materials_scatter", "KHR_materials_to_come", "KHR_materials_ior",
                                          "VENDOR_toon"};
    builder.document["extensionsRequired"] = {"KHR_materials_ior", "KHR_interactivity"};
    writeText(folder_ / "scene.gltf", builder.toGltf());
    EXPECT_EQ(json::parse(run({"inspect", "scene.gltf", "--json"}).out).at("extensions"), json({{"KHR_interactivity", "ignored"},
                                                                                                {"KHR_materials_ior", "drawn"},
                                                                                                {"KHR_materials_scatter", "drawn"},
                                                                                                {"KHR_materials_to_come", "missing"},
                                                                                                {"KHR_xmp_json_ld", "ignored"},
                                                                                                {"VENDOR_toon", "missing"}}));
    const std::string text = run({"inspect", "scene.gltf"}).out;
    for (const char* line :
         {"  extension KHR_materials_ior: drawn\n", "  extension KHR_xmp_json_ld: ignored, as it changes no still picture\n",
          "  extension VENDOR_toon: missing: the picture lacks what it asks for\n"}) {
        EXPECT_TRUE(contains(text, line)) << text << "lacks: " << line;
    }
}

// A ball of wax whose boundary is smooth, and a bulb.
TEST_F(LooksTest, InspectSaysHowVolumesScatterAndWhatLightMisses)
{
    writeBall();
    json document = jsonIn("scene.gltf");
    document["materials"][0]["name"] = "wax";
    document["materials"][0]["extensions"]["KHR_materials_subsurface"] = {{"scatterColor", {0.5, 0.5, 1}}, {"scatterDistance", 0.1}};
    writeText(folder_ / "scene.gltf", document.dump());
    EXPECT_TRUE(contains(run({"inspect", "scene.gltf"}).out,
                         "absorption (0.693, 0, 0) per metre, scattering (6.93, 6.93, 0) per metre, anisotropy 0\n"));
    const json ball = json::parse(run({"inspect", "scene.gltf", "--json"}).out);
    EXPECT_NEAR(ball.at("media")[0].at("scattering")[0], 10.0 * std::log(2.0), 1e-5);
    EXPECT_EQ(ball.at("media")[0].at("anisotropy"), 0);
    const auto warns = [&] {
        writeText(folder_ / "scene.gltf", document.dump());
        const json ids = json::parse(run({"inspect", "scene.gltf", "--json"}).out).at("warningIds");
        return std::find(ids.begin(), ids.end(), "unreached-volume") != ids.end();
    };
    EXPECT_FALSE(warns());
    document["extensions"]["KHR_lights_punctual"]["lights"] = json::array({{{"type", "point"}}});
    document["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    EXPECT_TRUE(warns());
    document["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.05;
    EXPECT_FALSE(warns());
}

// A ball of milk whose free path is a micrometre.
TEST_F(LooksTest, RendersSayHowManyWalksWereCut)
{
    writeBall();
    json document = jsonIn("scene.gltf");
    document["materials"][0]["extensions"]["KHR_materials_volume"].erase("attenuationDistance");
    document["materials"][0]["extensions"]["KHR_materials_subsurface"] = {{"scatterColor", {0.5, 0.5, 0.5}}, {"scatterDistance", 1e-6}};
    writeText(folder_ / "scene.gltf", document.dump());
    const GlimRun rendered =
        run({"render", "scene.gltf", "-o", "a.exr", "--size", "8x8", "--spp", "32", "--environment", "1,1,1", "--stats", "a.json"});
    const json statistics = jsonIn("a.json");
    EXPECT_GT(statistics.at("scatteringCaps"), 0);
    EXPECT_NEAR(statistics.at("cutThroughput"), statistics.at("scatteringCaps"), 0.01 * statistics.at("scatteringCaps").get<double>());
    expectSaid(rendered, MessageId::ScatteringCap,
               {.value = std::to_string(statistics.at("scatteringCaps").get<int>()), .expected = std::to_string(kMaxScatterings)});
}

TEST_F(LooksTest, InspectSaysWhatBecomesOfSingleSidedMaterials)
{
    const auto expectNone = [this] {
        EXPECT_EQ(json::parse(run({"inspect", "scene.gltf", "--json"}).out).at("singleSided"), 0);
        EXPECT_FALSE(contains(run({"inspect", "scene.gltf"}).out, "  single-sided: "));
    };
    writeCoated();
    EXPECT_EQ(json::parse(run({"inspect", "scene.gltf", "--json"}).out).at("singleSided"), 1);
    EXPECT_TRUE(
        contains(run({"inspect", "scene.gltf"}).out, "  single-sided: 1 material, whose back faces are not drawn (--back-faces)\n"));
    json document = jsonIn("scene.gltf");
    document["materials"][0]["doubleSided"] = true;
    writeText(folder_ / "scene.gltf", document.dump());
    expectNone();
    writeBall();  // it transmits
    expectNone();
}

// The triangle from behind, in a sky of radiance 1: it hides the sky or is not there, and its film is another one.
TEST_F(LooksTest, BackFacesAreLeftOutUnlessAskedFor)
{
    writeCoated();
    json document = jsonIn("scene.gltf");
    document["nodes"][0]["rotation"] = {0, 1, 0, 0};
    document["nodes"][0]["translation"] = {0.5, 0, 0};
    writeText(folder_ / "scene.gltf", document.dump());
    const auto meanOfFilm = [this](const Arguments& options) {
        Arguments all{"--environment", "1,1,1"};
        all.insert(all.end(), options.begin(), options.end());
        const GlimRun run = render(all);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        const std::vector<float> red = readExr((folder_ / "x.exr").string()).channels.at("R");
        return std::accumulate(red.begin(), red.end(), 0.0) / static_cast<double>(red.size());
    };
    EXPECT_EQ(meanOfFilm({}), 1.0);
    const GlimRun other = run({"render", "scene.gltf", "-o", "x.exr", "--size", "8x8", "--spp", "4", "--environment", "1,1,1",
                               "--back-faces", "shown", "--resume"});
    expectRefused(other, 1, Id::Mismatch, {.file = "x.exr"});
    EXPECT_LT(meanOfFilm({"--back-faces", "shown"}), 0.9);
    EXPECT_EQ(meanOfFilm({"--back-faces", "culled"}), 1.0);
    EXPECT_EQ(render({"--back-faces", "hidden"}).exitCode, 2);
}

TEST_F(LooksTest, ReplaysShowMaterialsAndLobes)
{
    writeCoated();
    std::map<std::string, int> lobes;
    for (int sample = 0; sample < 2; ++sample) {
        const GlimRun replay = run({"render", "scene.gltf", "--size", "8x8", "--environment", "1,1,1", "--replay",
                                    "4,4," + std::to_string(sample), "--stats", "r.json"});
        ASSERT_EQ(replay.exitCode, 0) << replay.err;
        EXPECT_TRUE(contains(replay.out, "\n  base colour (0.5, 0.25, 0.125), metallic 0.25, roughness 0.5, clearcoat 0.75\n"))
            << replay.out;
        const json vertex = jsonIn("r.json").at("vertices").at(0);
        const json values = vertex.at("surface").at("values");
        EXPECT_EQ(values.at("baseColor"), json({0.5, 0.25, 0.125}));
        EXPECT_EQ(values.at("clearcoat"), 0.75);
        EXPECT_EQ(values.at("alpha"), 1);
        EXPECT_TRUE(values.at("medium").is_null());
        const json next = vertex.at("next");
        if (!next.is_null()) {
            ++lobes[next.at("lobe")];
            EXPECT_EQ(next.at("delta"), next.at("lobe") == "clearcoat") << "the coat alone is smooth";
            EXPECT_EQ(next.at("pdf") == 0, next.at("delta"));
            EXPECT_TRUE(contains(replay.out, " by its " + next.at("lobe").get<std::string>() + " lobe"));
        }
    }
    EXPECT_FALSE(lobes.empty());
    writeBall();
    const GlimRun replay =
        run({"render", "scene.gltf", "--size", "8x8", "--environment", "1,1,1", "--replay", "4,4,1", "--stats", "r.json"});
    const json vertices = jsonIn("r.json").at("vertices");
    EXPECT_EQ(vertices.at(0).at("next").at("lobe"), "glass");
    EXPECT_EQ(vertices.at(0).at("next").at("delta"), true);
    EXPECT_EQ(vertices.at(0).at("next").at("transmitted"), true);
    EXPECT_EQ(vertices.at(1).at("surface").at("values").at("medium").at("number"), 1);
    EXPECT_TRUE(contains(replay.out, " by its glass lobe, delta, to the other side, with pdf 0")) << replay.out;
    EXPECT_TRUE(contains(replay.out, "reached through medium 1: index 1.5, absorption (0.69314")) << replay.out;
}

TEST_F(LooksTest, PicturesThatShowNothingSaySo)
{
    std::filesystem::copy_file(sceneFile("cornell.gltf"), folder_ / "scene.gltf");
    const GlimRun burnt = render({"--environment", "20000,20000,20000", "--png", "x.png"});
    EXPECT_EQ(burnt.exitCode, 0);
    const std::optional<Message> advice = findMessage(burnt, Id::ExposureAdvised);
    ASSERT_TRUE(advice) << burnt.err;
    EXPECT_EQ(advice->file, "x.png");
    EXPECT_LT(std::stod(advice->expected), 0.0);
    const auto isAdvised = [this](const Arguments& options) { return hasSaid(render(options), Id::ExposureAdvised); };
    EXPECT_FALSE(isAdvised({"--environment", "20000,20000,20000", "--png", "x.png", "--exposure", advice->expected}));
    EXPECT_FALSE(isAdvised({"--environment", "20000,20000,20000"})) << "an EXR has no exposure";
}

TEST_F(LooksTest, ToneMappingIsOfPicturesAlone)
{
    std::filesystem::copy_file(sceneFile("cornell.gltf"), folder_ / "scene.gltf");
    const auto drawn = [this](const Arguments& options) {
        Arguments all{"--png", "x.png", "--stats", "s.json"};
        all.insert(all.end(), options.begin(), options.end());
        const GlimRun done = render(all);
        EXPECT_EQ(done.exitCode, 0) << done.err;
        EXPECT_FALSE(hasSaid(done, Id::ToneChosen)) << done.err;
        return readFileBytes(folder_ / "x.png");
    };
    const std::string plain = drawn({});
    EXPECT_EQ(jsonIn("s.json").at("look"), json({{"exposure", 0}, {"tone", "none"}}));
    const std::string digest = jsonIn("s.json").at("digest");
    EXPECT_EQ(drawn({"--tone", "none"}), plain);
    const std::string neutral = drawn({"--tone", "neutral"}), agx = drawn({"--tone", "agx", "--exposure", "1.5"});
    EXPECT_EQ(jsonIn("s.json").at("look"), json({{"exposure", 1.5}, {"tone", "agx"}}));
    EXPECT_EQ(jsonIn("s.json").at("digest"), digest) << "the film has no tone";
    EXPECT_EQ((std::set<std::string>{plain, neutral, agx}.size()), 3U);
    render({"--stats", "s.json"});
    EXPECT_TRUE(jsonIn("s.json").at("look").is_null());
    ASSERT_EQ(run({"merge", "x.exr", "-o", "y.exr", "--image", "y.png", "--tone", "agx", "--exposure", "1.5"}).exitCode, 0);
    EXPECT_EQ(readFileBytes(folder_ / "y.png"), agx);
}

TEST_F(LooksTest, TheStudioIsShownByNeutralUnlessToldOtherwise)
{
    writeCoated();
    const auto isChosen = [this](const Arguments& options) { return hasSaid(render(options), Id::ToneChosen); };
    EXPECT_TRUE(isChosen({"--png", "a.png"}));
    for (const char* tone : {"neutral", "none"}) {
        EXPECT_FALSE(isChosen({"--png", "b.png", "--tone", tone}));
        EXPECT_EQ(readFileBytes(folder_ / "b.png") == readFileBytes(folder_ / "a.png"), tone == std::string("neutral")) << tone;
    }
    EXPECT_TRUE(isChosen({"--png", "b.png", "--environment", "studio"}));
    EXPECT_FALSE(isChosen({"--png", "b.png", "--environment", "1,1,1"}));
    EXPECT_FALSE(isChosen({"--png", "b.png", "--view", "normal"}));
    EXPECT_FALSE(isChosen({})) << "there is no picture";
}

TEST_F(LooksTest, ExposureIsChosenAndSaid)
{
    std::filesystem::copy_file(sceneFile("cornell.gltf"), folder_ / "scene.gltf");
    const GlimRun chosen = render({"--png", "a.png", "--exposure", "auto", "--stats", "s.json"});
    const std::optional<Message> exposure = findMessage(chosen, Id::ExposureChosen);
    ASSERT_TRUE(exposure) << chosen.err;
    EXPECT_TRUE(std::regex_match(exposure->value, std::regex("[+-][0-9]+\\.[0-9][0-9]"))) << exposure->value;
    EXPECT_EQ(jsonIn("s.json").at("look").at("exposure"), std::stod(exposure->value));
    const GlimRun asked = render({"--png", "b.png", "--exposure", exposure->value});
    EXPECT_EQ(findMessages(chosen.err).size(), findMessages(asked.err).size() + 1);
    EXPECT_EQ(readFileBytes(folder_ / "b.png"), readFileBytes(folder_ / "a.png"));
    const GlimRun merged = run({"merge", "x.exr", "-o", "y.exr", "--png", "b.png", "--exposure", "auto"});
    EXPECT_EQ(findMessage(merged, Id::ExposureChosen), exposure) << merged.err;
    EXPECT_EQ(readFileBytes(folder_ / "b.png"), readFileBytes(folder_ / "a.png"));
}

TEST_F(LooksTest, PicturesAreOfTheKindOfTheirName)
{
    std::filesystem::copy_file(sceneFile("cornell.gltf"), folder_ / "scene.gltf");
    const auto pixelsOf = [this](const std::string& name) {
        const std::string bytes = readFileBytes(folder_ / name.c_str());
        return decodeImage({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}).rgba8;
    };
    ASSERT_EQ(render({"--png", "x.png", "--image", "x.webp"}).exitCode, 0);
    const std::vector<std::uint8_t> pixels = pixelsOf("x.png");
    EXPECT_EQ(pixelsOf("x.webp"), pixels);
    ASSERT_EQ(
        run({"render", "scene.gltf", "-o", "f#.exr", "--size", "8x8", "--spp", "2", "--turntable", "2", "--image", "f#.jpeg"}).exitCode, 0);
    EXPECT_EQ(readFileBytes(folder_ / "f1.jpeg").substr(0, 3), "\xff\xd8\xff");
}

TEST_F(LooksTest, TexturesAreScaledDownOnDemand)
{
    writeCoated();
    const auto bytes = [this](const Arguments& options) {
        Arguments all{"inspect", "scene.gltf", "--json"};
        all.insert(all.end(), options.begin(), options.end());
        return json::parse(run(all).out).at("textures").at(0).at("bytes").get<int>();
    };
    EXPECT_EQ(bytes({}), 4 * 2 * 4);
    EXPECT_EQ(bytes({"--max-texture", "4"}), 4 * 2 * 4);
    EXPECT_EQ(bytes({"--max-texture", "3"}), 2 * 1 * 4);
    EXPECT_EQ(bytes({"--max-texture", "1"}), 0) << "one colour is part of the factor";
}

TEST_F(LooksTest, LargeTexturesAreStatedBeforeTheRender)
{
    writeCoated();
    Bytes texels(std::size_t{4096} * 4100 * 3, 7);
    texels[0] = 8;
    const Bytes png = encodePng(4096, 4100, texels);
    writeText(folder_ / "wood.png", {png.begin(), png.end()});
    const std::optional<Message> stated = findMessage(render({}), Id::TextureMemory);
    ASSERT_TRUE(stated);
    EXPECT_EQ(stated->value, "64 MiB");
    EXPECT_TRUE(contains(stated->sentence, "12 MiB")) << stated->sentence;
    EXPECT_FALSE(hasSaid(run({"inspect", "scene.gltf", "--max-texture", "2048"}), Id::TextureMemory));
}

TEST_F(LooksTest, NoTextureAndNoMapIsOverwritten)
{
    writeCoated();
    const std::string texture = readFileBytes(folder_ / "wood.png");
    const GlimRun run = render({"--png", "wood.png"});
    EXPECT_EQ(run.exitCode, 1);
    expectSaid(run, Id::Conflict, {.file = "wood.png", .value = "wood.png"});
    EXPECT_EQ(readFileBytes(folder_ / "wood.png"), texture);
    ASSERT_EQ(this->run({"render", sceneFile("cornell.gltf"), "-o", "x.exr", "--size", "4x4", "--spp", "1"}).exitCode, 0);
    const std::string map = readFileBytes(folder_ / "x.exr");
    expectRefused(render({"--environment", "x.exr"}), 1, Id::Conflict, {.file = "x.exr", .value = "x.exr"});
    EXPECT_EQ(readFileBytes(folder_ / "x.exr"), map);
}

// Each mistake is one sentence, and leaves nothing behind.
TEST_F(LooksTest, WhatCannotBeUsedIsRefused)
{
    writeCoated();
    writeText(folder_ / "empty.hdr", "");
    writeText(folder_ / "half.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\nab");
    writeText(folder_ / "text.exr", "this is no picture");
    std::filesystem::copy_file(folder_ / "wood.png", folder_ / "picture.hdr");
    std::filesystem::create_directory(folder_ / "folder.exr");
    const std::ptrdiff_t entries = folder_.entries();
    struct Case {
        std::string option, value;
        int exitCode;
        MessageId id;
        Parts parts;
    };
    const auto usage = [](MessageId id, const std::string& option, const std::string& value, const std::string& expected = "") {
        return Case{option, value, 2, id, {.place = option, .value = value, .expected = expected}};
    };
    const auto map = [](MessageId id, const std::string& file, const Parts& parts = {}) {
        return Case{"--environment", file, 1, id, {file, parts.place, parts.value, parts.expected}};
    };
    const std::vector<Case> cases{
        usage(Id::Malformed, "--environment", "wood.png", ".hdr or .exr"),
        map(Id::UnknownFormat, "picture.hdr", {.expected = "OpenEXR nor Radiance (.hdr)"}),
        map(Id::UnknownFormat, "empty.hdr"),
        map(Id::FileDamaged, "half.hdr", {.place = "row 0"}),
        map(Id::UnknownFormat, "text.exr"),
        map(Id::WrongType, "folder.exr", {.value = "a folder"}),
        map(Id::FileMissing, "none.hdr"),
        usage(Id::Malformed, "--environment", "1,1"),
        usage(Id::Malformed, "--environment", ""),
        usage(Id::Malformed, "--sun", "30,45"),
        usage(Id::OutOfRange, "--sun", "30,91,1", "within 360 and 90"),
        usage(Id::OutOfRange, "--sun", "0,0,-1", ">= 0"),
        usage(Id::OutOfRange, "--environment-rotation", "nan", "-360 to 360"),
        usage(Id::OutOfRange, "--environment-rotation", "1e9", "-360 to 360"),
        usage(Id::UnknownName, "--environment-background", "ON", "off or on"),
        usage(Id::UnknownName, "--missing-textures", "Grey", "refuse or grey"),
        usage(Id::OutOfRange, "--max-texture", "0", "1 to 16384"),
        usage(Id::OutOfRange, "--max-texture", "-5"),
        usage(Id::OutOfRange, "--max-texture", "16385"),
        usage(Id::Malformed, "--max-texture", "big"),
        {"--variant", "night", 1, Id::UnknownName, {.file = "scene.gltf", .value = "night", .expected = "no --variant"}},
    };
    for (const Case& refused : cases) {
        SCOPED_TRACE(refused.option + " " + refused.value);
        const GlimRun run = render({refused.option, refused.value, "--png", "x.png", "--stats", "s.json"});
        expectRefused(run, refused.exitCode, refused.id, refused.parts);
        EXPECT_EQ(folder_.entries(), entries);
    }
    expectRefused(render({"--png", "x.png", "--max-texture"}), 2, Id::Missing, {.place = "--max-texture"});
    EXPECT_EQ(folder_.entries(), entries);
}

}  // namespace
}  // namespace glim::test
