// Files, names and machines that nobody means to give to glim: it says so in one sentence of bounded length, and ends.
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace glim::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Runs glim with this many KiB of addresses.
GlimRun runLimited(unsigned kibibytes, const std::vector<std::string>& arguments)
{
    GlimCall call;
    call.program = "/bin/sh";
    call.arguments = {"-c", "ulimit -v " + std::to_string(kibibytes) + " && exec \"$0\" \"$@\"", GLIM_BINARY};
    call.arguments.insert(call.arguments.end(), arguments.begin(), arguments.end());
    return runGlim(call);
}

TEST(CommandLineTest, TooLittleMemoryNamesTheFileAndTheAmount)
{
    const ScratchFolder folder;
    json document = oneTriangle().document;
    for (int i = 0; i < 1000000; ++i) {
        document["nodes"].push_back(json::object());
    }
    const std::string scene = (folder / "nodes.gltf").string();
    writeText(scene, document.dump());
    const GlimRun run = runLimited(150000, {"inspect", scene});
    EXPECT_EQ(run.exitCode, 1);
    EXPECT_EQ(run.err, "glim: " + scene + ": there is not enough memory; the process may take 146 MiB (ulimit -v).\n");
}

TEST(CommandLineTest, TooFewAddressesForTheDriverAreSaid)
{
    const ScratchFolder folder;
    const std::string picture = (folder / "x.exr").string();
    for (const unsigned limit : {200000U, 800000U}) {
        const GlimRun run = runLimited(limit, {"render", sceneFile("cornell.gltf"), "-o", picture, "--size", "8x8", "--spp", "1"});
        EXPECT_NE(run.exitCode, 0);
        EXPECT_EQ(run.signal, 0);
        EXPECT_TRUE(contains(run.err, "(ulimit -v)")) << run.err;
        EXPECT_EQ(countLines(run.err), 1U) << run.err;
    }
    EXPECT_EQ(folder.entries(), 0);
}

TEST(CommandLineTest, ControlCharactersDoNotReachTheTerminal)
{
    const ScratchFolder folder;
    GltfBuilder builder = oneTriangle();
    const char name[] = "red\x1b[31m\nline\xc2\x9b";
    builder.document["nodes"][0]["name"] = name;
    builder.addNode({{"mesh", 0}, {"name", name}, {"scale", {0, 0, 0}}});
    builder.append("cameras", {{"name", name}, {"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
    builder.addNode({{"camera", 0}});
    const std::string scene = (folder / "scene.gltf").string();
    writeText(scene, builder.toGltf());
    const auto expectClean = [](const GlimRun& run) {
        for (const char* raw : {"\x1b", "\xc2\x9b", "\nline"}) {
            EXPECT_FALSE(contains(run.err + run.out, raw)) << run.err << run.out;
        }
        EXPECT_TRUE(contains(run.err + run.out, "\\x1b[31m")) << run.err << run.out;
    };
    expectClean(runGlim({"inspect", scene}));
    const std::string picture = folder.path().string() + "/\x1b[31m.exr";
    expectClean(runGlim({"render", scene, "-o", picture, "--size", "4x4", "--spp", "1"}));
    expectClean(runGlim({"render", scene, "-o", picture, "--camera", "x"}));
    expectClean(runGlim({"inspect", name}));
    expectClean(runGlim({"render", scene, "--size", name}));
    expectClean(runGlim({name}));
}

TEST(CommandLineTest, MessagesAreBounded)
{
    const ScratchFolder folder;
    GltfBuilder builder = oneTriangle();
    builder.addNode({{"mesh", 0}, {"name", std::string(1 << 20, 'a')}, {"scale", {0, 0, 0}}});
    json extensions = json::object();
    for (int i = 0; i < 100000; ++i) {
        extensions["EXT_materials_" + std::to_string(i)] = json::object();
    }
    builder.append("materials", {{"extensions", extensions}});
    builder.document["meshes"][0]["primitives"][0]["material"] = 0;
    const std::string scene = (folder / "scene.gltf").string();
    writeText(scene, builder.toGltf());
    const GlimRun run = runGlim({"inspect", scene, "--json"});
    EXPECT_EQ(run.exitCode, 0) << run.err.substr(0, 1000);
    EXPECT_LE(countLines(run.err), 25U);
    EXPECT_LE(run.err.size(), 5000U);
    EXPECT_TRUE(contains(run.err, "more warnings\n"));
    EXPECT_TRUE(contains(run.err, "nodes[1] (\"" + std::string(80, 'a') + "...\")")) << run.err.substr(0, 1000);
}

TEST(CommandLineTest, NamesThatAreTooLongAreRefusedBeforeAnyWork)
{
    const ScratchFolder folder;
    const std::string stem = (folder / "").string() + std::string(252, 'a');
    const auto expectTooLong = [](const GlimRun& run, const std::string& file) {
        expectRefused(run, 1, MessageId::FileUnwritable, {.file = file, .value = "File name too long"});
    };
    for (const std::vector<std::string>& options : {std::vector<std::string>{"-o", stem + ".exr"},
                                                    {"-o", "x.exr", "--png", stem + ".png"},
                                                    {"-o", "x.exr", "--rates", stem + ".png"},
                                                    {"-o", "x.exr", "--ids", stem + ".exr"},
                                                    {"-o", "x.exr", "--stats", stem + ".json"}}) {
        GlimCall call;
        call.arguments = {"render", "no-such-scene.gltf"};
        call.arguments.insert(call.arguments.end(), options.begin(), options.end());
        call.folder = folder.path();
        expectTooLong(runForMessages(call), options.back());
    }
    expectTooLong(runForMessages({"merge", "a.exr", "-o", stem + ".exr"}), stem + ".exr");
    expectTooLong(runForMessages({"compare", "a.exr", "b.exr", "--diff", stem + ".exr"}), stem + ".exr");
    EXPECT_EQ(folder.entries(), 0);
}

TEST(CommandLineTest, AMissingSceneIsSaidBeforeAMissingDisplay)
{
    GlimCall call;
    call.arguments = {"preview", "no-such-scene.gltf"};
    call.environment.insert({{"DISPLAY", ":4711"}, {"WAYLAND_DISPLAY", "nowhere"}});
    expectRefused(runForMessages(call), 1, MessageId::FileMissing, {.file = "no-such-scene.gltf"});
}

}  // namespace
}  // namespace glim::test
