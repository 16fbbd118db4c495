// What the window prints and saves of what it shows: a render by either has the bits of the film that the window writes.
#include "tests/support/gltf_builder.hpp"
#include "tests/support/preview_fixture.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

namespace glim::test {
namespace {

class PreviewEditsTest : public PreviewTest {
protected:
    PreviewEditsTest()
    {
        GltfBuilder builder = posedTriangle();
        nlohmann::json& animations = builder.document["animations"];
        animations.push_back(animations[0]);
        animations[1]["name"] = "turn";
        animations[1]["channels"].erase(1);
        scene = folder / "posed.gltf";
        std::ofstream(scene) << builder.toGltf();
        std::filesystem::create_directories(folder / "maps");
        std::filesystem::create_directories(folder / "elsewhere");
        std::filesystem::copy_file(GLIM_SOURCE_DIR "/scenes/sun.hdr", folder / "maps/the sun's.hdr");
        std::filesystem::copy_file(scene, folder / "maps/more.gltf");
    }

    // Of a shell's command line in a folder.
    Film renderBy(const std::string& words, const char* where) const
    {
        GlimCall made;
        made.program = "/bin/sh";
        made.arguments = {"-c", std::string(GLIM_BINARY) + " render '" + scene + "' -o by.exr --spp 2 --caustics off " + words};
        made.folder = folder / where;
        const GlimRun done = runGlim(made);
        EXPECT_EQ(done.exitCode, 0) << words << done.err;
        return readFilm(folder / where / "by.exr");
    }

    nlohmann::json saved(const char* name) const { return nlohmann::json::parse(std::ifstream(folder / name)); }
};

TEST_F(PreviewEditsTest, RendersHaveTheBitsOfTheWindowsFilm)
{
    const GlimRun session = run("0 samples 2\n0 drag left 10,10 30,14\n0.2 samples 2\n0 key C\n0 key J\n0 key P\n0 close\n",
                                {"--spp",
                                 "2",
                                 "--environment",
                                 "maps/the sun's.hdr",
                                 "--environment-rotation",
                                 "33.3",
                                 "--sun",
                                 "30,45,2",
                                 "--floor",
                                 "lowest",
                                 "--back-faces",
                                 "shown",
                                 "--add",
                                 "maps/more.gltf@0,0.5,-1",
                                 "--set",
                                 "/nodes/0/translation=0.2,0,0",
                                 "--set",
                                 "maps/more.gltf#/nodes/0/scale=0.5,1,1",
                                 "--at",
                                 "0.25",
                                 "--animation",
                                 "turn",
                                 "--fov",
                                 "50"});
    EXPECT_NE(session.err.find("wrote posed-001.edits.json"), std::string::npos) << session.err;
    const std::string options = firstLine(session.out);
    EXPECT_NE(options.find(" --look-from "), std::string::npos) << options;
    EXPECT_NE(options.find(" --environment 'maps/the sun'\\''s.hdr' --environment-rotation 33.3 --sun 30,45,2 "), std::string::npos)
        << options;
    const Film shown = film(1), byFile = renderBy("--edits ../posed-001.edits.json", "elsewhere"), byLine = renderBy(options, ".");
    EXPECT_TRUE(sameBits(shown, byFile));
    EXPECT_TRUE(sameBits(shown, byLine));
    EXPECT_EQ(shown.identity.settings, byFile.identity.settings);
    EXPECT_EQ(shown.identity.settings, byLine.identity.settings);
    EXPECT_EQ(byFile.identity.scene, byLine.identity.scene);
    EXPECT_FALSE(sameBits(shown, renderBy(options.substr(0, options.find(" --set")), "."))) << "the edits show";
    run("0 samples 2\n0 key P\n0 close\n", {"--spp", "2", "--edits", "posed-001.edits.json"});
    EXPECT_TRUE(sameBits(shown, film(2))) << "a window by the file";
}

TEST_F(PreviewEditsTest, TheFileHasTheLook)
{
    run("0 samples 2\n0 key +\n0 key T\n0 key J\n0 key P\n0 close\n", {"--spp", "2", "--environment", "1,1,1"});
    EXPECT_EQ(saved("posed-001.edits.json"), nlohmann::json::parse(R"({"camera": 0, "size": "96x72", "exposure": 0.5, "tone": "neutral",
                                                                       "environment": [1, 1, 1]})"));
    render("--spp 2 --edits posed-001.edits.json");
    EXPECT_EQ(picture(1), rendered());
}

TEST_F(PreviewEditsTest, NoFileIsReplaced)
{
    std::ofstream(folder / "posed-001.edits.json") << "mine";
    const GlimRun session = run("0 samples 1\n0 key J\n0 key J\n0 close\n", {"--spp", "1", "--environment", "1,1,1"});
    EXPECT_EQ(readFileBytes(folder / "posed-001.edits.json"), "mine");
    EXPECT_NE(session.err.find("wrote posed-002.edits.json"), std::string::npos) << session.err;
    EXPECT_NE(session.err.find("wrote posed-003.edits.json"), std::string::npos) << session.err;
    EXPECT_EQ(saved("posed-002.edits.json"), saved("posed-003.edits.json"));
}

TEST_F(PreviewEditsTest, AFramedCameraIsOneAgain)
{
    scene = sceneFile("cornell_spheres.gltf");
    const GlimRun session = run("0 samples 2\n0 key C\n0 key P\n0 close\n", {"--spp", "2", "--camera", "framed"});
    EXPECT_EQ(firstLine(session.out), "--camera framed --size 96x72");
    EXPECT_TRUE(sameBits(film(1), renderBy(firstLine(session.out), ".")));
}

}  // namespace
}  // namespace glim::test
