// The program among its surroundings: devices, inspect, an installation, a machine without driver or display.
#include "places.h"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <regex>

namespace glim::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

GlimCall pixelsOfCornell(const ScratchFolder& folder, const std::vector<std::string>& options = {})
{
    GlimCall call;
    call.arguments = {"render", sceneFile("cornell.gltf"), "-o", "x.exr", "--size", "8x8", "--spp", "1"};
    call.arguments.insert(call.arguments.end(), options.begin(), options.end());
    call.folder = folder.path();
    return call;
}

json listDevices()
{
    const GlimRun run = runGlim({"devices", "--json"});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    return json::parse(run.out);
}

TEST(CommandLineTest, DevicesAreListedWithWhatMatters)
{
    const json devices = listDevices();
    ASSERT_GE(devices.size(), 1U);
    const GlimRun text = runGlim({"devices"});
    EXPECT_EQ(text.exitCode, 0);
    for (const json& device : devices) {
        EXPECT_GT(device.at("memory"), 0);
        EXPECT_GT(device.at("subgroupSize"), 0);
        EXPECT_GT(device.at("maxStorageBuffer"), 0);
        EXPECT_GT(device.at("maxTexelElements"), 0);
        EXPECT_NE(device.at("kind"), "");
        EXPECT_TRUE(contains(text.out, device.at("name"))) << text.out;
        EXPECT_TRUE(contains(text.out, device.at("driver"))) << text.out;
    }
}

TEST(CommandLineTest, DevicesAreChosenByIndexAndByPartOfTheName)
{
    const std::string name = listDevices().at(0).at("name");
    std::string part = name.substr(0, 5);
    std::transform(part.begin(), part.end(), part.begin(), [](unsigned char c) { return std::toupper(c); });
    for (const std::string& choice : {std::string("0"), part}) {
        const ScratchFolder folder;
        const GlimRun run = runGlim(pixelsOfCornell(folder, {"--device", choice}));
        EXPECT_EQ(run.exitCode, 0) << run.err;
        EXPECT_TRUE(contains(run.out, "on " + name)) << run.out;
    }
}

TEST(CommandLineTest, WithoutADriverTheSentenceSaysWhatToInstall)
{
    const ScratchFolder folder;
    GlimCall call = pixelsOfCornell(folder);
    for (const auto& arguments : {call.arguments, std::vector<std::string>{"devices"}}) {
        call.arguments = arguments;
        call.environment.insert({{"VK_DRIVER_FILES", "/nonexistent"}, {"VK_ICD_FILENAMES", "/nonexistent"}});
        const GlimRun run = runGlim(call);
        EXPECT_EQ(run.exitCode, 3);
        EXPECT_TRUE(contains(run.err, "mesa-vulkan-drivers")) << run.err;
        EXPECT_EQ(run.err.rfind("glim: ", 0), 0U) << run.err;
        EXPECT_EQ(countLines(run.err), 1U) << run.err;
        EXPECT_EQ(run.out, "");
    }
    EXPECT_EQ(folder.entries(), 0);
}

// A sphere that emits, two triangles a metre apart, a camera without a name.
std::string knownScene()
{
    GltfBuilder builder;
    const std::size_t mesh = builder.addTriangleMesh();
    builder.document["extensionsUsed"] = {"KHR_materials_emissive_strength"};  // it is a lamp and no display
    builder.append("materials",
                   {{"emissiveFactor", {1, 1, 1}}, {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 10}}}}}});
    builder.addNode({{"mesh", mesh}});
    builder.addNode({{"mesh", mesh}, {"translation", {0, 0, -1}}});
    builder.addNode({{"translation", {0, 0, 3}}, {"extras", {{"sphere", {{"radius", 0.5}, {"material", 0}}}}}});
    return builder.toGltf();
}

TEST(CommandLineTest, ResultsThatCannotBeWrittenAreAFailure)
{
    const std::string command = "'" GLIM_BINARY "' devices >/dev/full";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
}

// As with a full disk: one sentence, and no file that is not whole.
TEST(CommandLineTest, FilesThatWouldGrowTooLargeAreNotWritten)
{
    const ScratchFolder folder;
    const std::string scene = sceneFile("cornell.gltf"), film = (folder / "film.exr").string();
    for (const char* name : {"film.exr", "other.exr"}) {
        const std::string seed = name[0] == 'f' ? "0" : "1";
        ASSERT_EQ(runGlim({"render", scene, "-o", (folder / name).string(), "--size", "64x64", "--spp", "2", "--seed", seed}).exitCode, 0);
    }
    const std::vector<std::pair<const char*, std::vector<std::string>>> cases{
        {"new.exr", {"render", scene, "-o", "new.exr", "--size", "64x64", "--spp", "2"}},
        {"new.exr", {"render", scene, "-o", "new.exr", "--size", "64x64", "--spp", "64", "--denoise"}},
        {"film.exr", {"render", scene, "-o", "film.exr", "--size", "64x64", "--spp", "4"}},
        {"new.exr", {"merge", "film.exr", "-o", "new.exr"}},
        {"d.exr", {"compare", "film.exr", "other.exr", "--diff", "d.exr"}},
        {"d.png", {"compare", "film.exr", "other.exr", "--diff-png", "d.png"}},
        {"r.json", {"render", scene, "--replay", "3,3,0", "--size", "64x64", "--stats", "r.json"}},
    };
    for (const auto& [file, arguments] : cases) {
        SCOPED_TRACE(arguments[0] + " " + file);
        GlimCall call;
        call.arguments = arguments;
        call.folder = folder.path();
        const std::string before = readFileBytes(film);
        const GlimRun run = runForMessages(afterCommand("ulimit -f 1", call));
        EXPECT_EQ(run.signal, 0);
        EXPECT_EQ(run.exitCode, 1);
        expectSaid(run, MessageId::FileUnwritable, {.file = file, .value = "File too large"});
        EXPECT_EQ(readFileBytes(film), before);
        EXPECT_EQ(folder.entries(), 2);
    }
    GlimCall inspect;
    inspect.arguments = {"inspect", scene, "--json"};
    inspect.folder = folder.path();
    const GlimRun run = runGlim(afterCommand("ulimit -f 1", inspect, ">out"));
    EXPECT_EQ(run.exitCode, 1);
    EXPECT_EQ(run.err, "glim: The results could not be written to standard output.\n");
}

TEST(CommandLineTest, InspectCountsWhatIsThere)
{
    const ScratchFolder folder;
    const std::string scene = (folder / "known.gltf").string();
    writeText(scene, knownScene());
    const GlimRun run = runGlim({"inspect", scene, "--json"});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const json found = json::parse(run.out);
    EXPECT_EQ(found.at("counts").at("triangles"), 2);
    EXPECT_EQ(found.at("counts").at("spheres"), 1);
    EXPECT_EQ(found.at("counts").at("lights"), 1);
    const std::vector<double> low = found.at("bounds").at("low"), high = found.at("bounds").at("high");
    for (const auto& [value, expected] : {std::pair(low[0], -0.5), {low[1], -0.5}, {low[2], -1.0}, {high[0], 1.0}, {high[2], 3.5}}) {
        EXPECT_NEAR(value, expected, 1e-5);
    }
    EXPECT_GE(found.at("bvh").at("depth"), 1);
    EXPECT_GT(found.at("bvh").at("surfaceAreaCost"), 0.0);
    EXPECT_GT(found.at("deviceBytes"), 3 * 36);
    EXPECT_EQ(found.at("needs").at("spheres"), true);
    EXPECT_EQ(found.at("needs").at("triangle lights"), false);
    EXPECT_EQ(found.at("needs").at("sphere lights"), true);
    EXPECT_EQ(found.at("needs").at("punctual lights"), false);
    const GlimRun text = runGlim({"inspect", scene});
    EXPECT_EQ(text.exitCode, 0);
    // Sizes in MiB, and three digits of what is not a count.
    const std::string digits = R"([-+.e0-9]{1,9})", point = "\\(" + digits + ", " + digits + ", " + digits + "\\)";
    for (const std::string& line : {std::string("triangles 2"), std::string("spheres 1"), "bounds " + point + " to " + point + " m",
                                    "BVH: [0-9]+ nodes, depth [0-9]+, surface-area cost " + digits + ", built in " + digits + " s",
                                    "on the device: " + digits + " MiB, " + digits + " MiB of it textures",
                                    std::string("needs: [-A-Za-z ]+(, [-A-Za-z ]+)*"), std::string("camera 0 \"framed\", perspective")}) {
        EXPECT_TRUE(std::regex_search(text.out, std::regex("\n  " + line + "\n"))) << text.out << "lacks: " << line;
    }
    EXPECT_TRUE(contains(text.out, "\n  bounds (-0.5, -0.5, -1) to (1, 1, 3.5) m\n")) << text.out;
    EXPECT_EQ(folder.entries(), 1);
}

TEST(CommandLineTest, ScenesWithoutCameraOrLightAreFramedAndSaid)
{
    const ScratchFolder folder;
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    writeText(folder / "dark.gltf", builder.toGltf());
    GlimCall call = pixelsOfCornell(folder);
    call.arguments[1] = "dark.gltf";
    const GlimRun run = runForMessages(call);
    EXPECT_EQ(run.exitCode, 0) << run.err;
    expectSaid(run, MessageId::FramedCamera);
    expectSaid(run, MessageId::StudioLight);
    call.arguments.insert(call.arguments.end(), {"--environment", "1,1,1"});
    EXPECT_FALSE(hasSaid(runForMessages(call), MessageId::StudioLight));
}

TEST(CommandLineTest, AnInstalledAndMovedProgramRendersWithoutADisplay)
{
    const ScratchFolder folder;
    const fs::path prefix = folder / "prefix", home = folder / "home", bin = folder / "bin";
    const std::string install = "cmake --install '" GLIM_BUILD_DIR "' --prefix '" + prefix.string() + "' >/dev/null";
    ASSERT_EQ(std::system(install.c_str()), 0);
    fs::create_directory(home);
    fs::create_directory(bin);
    fs::rename(prefix / "bin" / "glim", bin / "glim");
    fs::remove_all(prefix);
    fs::copy_file(sceneFile("cornell.gltf"), home / "my scéne.gltf");
    GlimCall call = pixelsOfCornell(folder);
    call.program = bin / "glim";
    call.folder = home;
    call.arguments[1] = "my scéne.gltf";
    call.environment.insert({{"DISPLAY", std::nullopt}, {"WAYLAND_DISPLAY", std::nullopt}});
    const GlimRun run = runGlim(call);
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_TRUE(fs::exists(home / "x.exr"));
    EXPECT_EQ(std::distance(fs::directory_iterator(home), fs::directory_iterator()), 2);
}

// A display that is named but not there (a stale DISPLAY over ssh) matters only to preview.
TEST(CommandLineTest, NoDisplayIsNeededToRender)
{
    const ScratchFolder folder;
    GlimCall call = pixelsOfCornell(folder);
    call.environment.insert({{"DISPLAY", ":4711"}, {"WAYLAND_DISPLAY", "nowhere"}});
    const GlimRun run = runGlim(call);
    EXPECT_EQ(run.exitCode, 0) << run.err;
}

}  // namespace
}  // namespace glim::test
