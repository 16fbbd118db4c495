// What the window's panel of the scene changes: `glim render` makes the same by the options that C prints. Nothing is loaded again.
#include "tests/support/gltf_builder.hpp"
#include "tests/support/preview_fixture.hpp"

#include <fstream>

namespace glim::test {
namespace {

// Where the controls are is known from a look at the window.
class PreviewSceneTest : public PreviewTest {
protected:
    PreviewSceneTest()
    {
        width = 640;
        height = 480;
        panels = true;
        scene = folder / "varied.gltf";
        std::ofstream(scene) << variedTriangle().toGltf();
    }

    // With the panel of the scene open, and C and P at the end.
    std::string change(const std::string& script, const std::vector<std::string>& more) const
    {
        std::vector<std::string> options{"--spp", "1"};
        options.insert(options.end(), more.begin(), more.end());
        const GlimRun session =
            run("0 samples 1\n0 click 547,471\n0.2 samples 1\n" + script + "0.3 samples 1\n0 key C\n0 key P\n0 close\n", options);
        EXPECT_EQ(session.err.find("loaded again"), std::string::npos);
        const std::string printed = firstLine(session.out);
        EXPECT_TRUE(sameBits(film(1), render("--spp 1 " + printed))) << printed;
        return printed;
    }
};

TEST_F(PreviewSceneTest, TurnsScalesAndHidesTheEnvironment)
{
    const std::string options =
        change("0 drag left 420,348 500,348\n0 drag left 430,371 480,371\n0.2 click 395,394\n", {"--environment", "studio"});
    EXPECT_NE(options.find(" --environment studio "), std::string::npos) << options;
    EXPECT_NE(options.find(" --environment-rotation "), std::string::npos) << options;
    EXPECT_NE(options.find(" --environment-strength "), std::string::npos) << options;
    EXPECT_NE(options.find(" --environment-background off"), std::string::npos) << options;
}

// One drag is one change to be undone.
TEST_F(PreviewSceneTest, DragsTheSunAndUndoesIt)
{
    const std::string drags =
        "0 click 395,417\n0.3 click 458,348\n0.2 drag left 300,200 360,180\n0.2 drag left 300,200 360,180\n0.2 samples 1\n";
    const std::string twice = change(drags, {"--environment", "studio"});
    EXPECT_NE(twice.find(" --sun 90,60,3"), std::string::npos) << twice;
    removePictures();
    std::ofstream(scene) << variedTriangle().toGltf();
    const std::string once = change(drags + "0 key Z\n", {"--environment", "studio"});
    EXPECT_NE(once.find(" --sun 67.5,52.5,3"), std::string::npos) << once;
}

// The second of two variants in the list.
TEST_F(PreviewSceneTest, ChoosesAVariant)
{
    const std::string options = change("0 click 500,440\n0.3 click 420,416\n", {"--environment", "studio"});
    EXPECT_TRUE(options.ends_with(" --variant night --environment studio")) << options;
}

// A floor, another colour for it, and a look at it as a shadow catcher.
TEST_F(PreviewSceneTest, PutsAFloorUnderTheScene)
{
    const std::string floor = "0 click 395,463\n0.3 drag left 400,463 380,463\n";
    const std::string shown = change(floor, {"--environment", "studio"});
    EXPECT_NE(shown.find(" --floor lowest --floor-color "), std::string::npos) << shown;
    EXPECT_TRUE(film(1).catcher.empty());
    removePictures();
    std::ofstream(scene) << variedTriangle().toGltf();
    const std::string caught = change(floor + "0.2 click 460,440\n", {"--environment", "studio"});
    EXPECT_TRUE(caught.ends_with(" --catcher floor")) << caught;
    EXPECT_FALSE(film(1).catcher.empty());
}

// Studio, none, constant, and a map beside the scene.
TEST_F(PreviewSceneTest, OpensAnotherEnvironment)
{
    std::ofstream(folder / "sky.hdr", std::ios::binary) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"
                                                        << std::string("\x80\x40\x20\x81\x20\x80\x40\x81", 8);
    const std::string options = change("0 click 500,325\n0.3 click 420,410\n", {"--environment", "studio"});
    EXPECT_NE(options.find("sky.hdr"), std::string::npos) << options;
}

// The points are chosen by a click.
TEST_F(PreviewSceneTest, HidesAndIsolates)
{
    const std::string click = "0 samples 1\n0 click 420,200\n0.3 samples 1\n", hide = "0 click 26,332\n", isolate = "0 click 80,332\n";
    const std::string showAll = "0 click 175,332\n", print = "0.3 samples 1\n0 key C\n0 key P\n";
    const GlimRun session = run(click + isolate + print + showAll + print + hide + print + "0 key Z\n" + print + "0 close\n",
                                {"--spp", "1", "--environment", "studio"});
    const std::string own = "--camera 0 --size 640x480 --environment studio", invisible = "/extensions/KHR_node_visibility/visible=false";
    const std::vector<std::string> expected{own + " --set /nodes/0" + invisible, own, own + " --set /nodes/2" + invisible, own};
    EXPECT_EQ(printedOptions(session), expected);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_TRUE(sameBits(film(static_cast<int>(i) + 1), render("--spp 1 " + expected[i]))) << i;
    }
}

}  // namespace
}  // namespace glim::test
