// What the window's panels and keys do to time, lens and field of view: `glim render` makes the same by the options that C prints.
#include "tests/support/gltf_builder.hpp"
#include "tests/support/preview_fixture.hpp"

#include <cstdio>
#include <fstream>

namespace glim::test {
namespace {

// The number after an option; fails if it is not there.
double numberAfter(const std::string& option, const std::string& options)
{
    const std::size_t place = options.find(option + " ");
    double number = -1.0;
    EXPECT_EQ(place == std::string::npos ? 0 : std::sscanf(options.c_str() + place + option.size(), "%lf", &number), 1) << options;
    return number;
}

class PreviewTimeTest : public PreviewTest {
protected:
    PreviewTimeTest()
    {
        GltfBuilder builder = posedTriangle();
        nlohmann::json& animations = builder.document["animations"];
        animations[0]["name"] = "both";
        animations.push_back(animations[0]);
        animations[1]["name"] = "turn";
        animations[1]["channels"].erase(1);
        scene = folder / "posed.gltf";
        std::ofstream(scene) << builder.toGltf();
    }

    GlimRun play(const std::string& script, std::vector<std::string> more = {}) const
    {
        more.insert(more.end(), {"--spp", "2", "--environment", "1,1,1"});
        return run("0 samples 2\n" + script + "0 close\n", more);
    }
    Film renderAt(const std::string& options) const { return render("--spp 2 " + options); }
};

// From the rest pose.
TEST_F(PreviewTimeTest, KeyPlaysAndPauses)
{
    const GlimRun session = play("0 key C\n0 key P\n0 key K\n0.3 key K\n0.3 samples 2\n0 key C\n0 key P\n");
    const std::vector<std::string> options = printedOptions(session);
    ASSERT_EQ(options.size(), 2U) << session.out;
    EXPECT_EQ(options[0], "--camera 0 --size 96x72 --environment 1,1,1");
    const double at = numberAfter("--at", options[1]);
    EXPECT_GT(at, 0.02);
    EXPECT_LT(at, 1.0);
    EXPECT_TRUE(options[1].ends_with(" --animation 0")) << options[1];
    const Film rest = renderAt(options[0]), posed = renderAt(options[1]);
    EXPECT_TRUE(sameBits(film(1), rest));
    EXPECT_TRUE(sameBits(film(2), posed));
    EXPECT_EQ(film(2).identity.settings, posed.identity.settings);
    EXPECT_FALSE(sameBits(rest, posed));
    EXPECT_EQ(session.err.find("loaded again"), std::string::npos);
}

// P pauses as well: otherwise there would be no whole picture.
TEST_F(PreviewTimeTest, WritesThePictureOfTheTimeWhenItPlays)
{
    const GlimRun session = run("0 samples 1\n0 key K\n0.3 key P\n0 key C\n0 close\n",
                                {"--spp", "1", "--environment", "1,1,1", "--at", "0.25", "--animation", "turn"});
    const std::vector<std::string> options = printedOptions(session);
    ASSERT_EQ(options.size(), 1U) << session.out;
    EXPECT_GT(numberAfter("--at", options[0]), 0.25);
    EXPECT_TRUE(options[0].ends_with(" --animation 1")) << options[0];
    const Film made = film(1), posed = render("--spp 1 " + options[0]);
    EXPECT_TRUE(sameBits(made, posed));
}

// An edit and a time together; the edit is undone at that time.
TEST_F(PreviewTimeTest, KeepsEditsAndTheMovedCamera)
{
    const GlimRun session =
        play("0 drag left 10,10 30,10\n0 key K\n0.2 key K\n0.3 samples 2\n0 key C\n0 key P\n", {"--set", "/nodes/0/translation=0.2,0,0"});
    const std::vector<std::string> options = printedOptions(session);
    ASSERT_EQ(options.size(), 1U) << session.out;
    EXPECT_NE(options[0].find(" --look-from "), std::string::npos) << options[0];
    EXPECT_GT(numberAfter("--at", options[0]), 0.0);
    EXPECT_TRUE(sameBits(film(1), renderAt(options[0])));
}

TEST_F(PreviewTimeTest, ShowsPicturesWhileItPlays)
{
    const Watched seen = watch(20, "0 samples 2\n0 key P\n0.5 key K\n", {"--spp", "2", "--environment", "1,1,1"});
    EXPECT_GE(seen.pictures.size(), 20U);
}

// The file is saved while a time is shown.
TEST_F(PreviewTimeTest, StaysAtTheTimeWhenTheFileChanges)
{
    GlimCall session = call("0 samples 2\n0 key K\n0.3 key K\n0.3 samples 2\n0 key P\n8 samples 2\n0 key C\n0 key P\n0 close\n",
                            {"--spp", "2", "--environment", "1,1,1"});
    bool isSaved = false;
    session.signalWhen = [&](const std::string& err) {
        if (!isSaved && err.find("wrote") != std::string::npos) {
            isSaved = true;
            nlohmann::json document = nlohmann::json::parse(std::ifstream(scene));
            document["nodes"][0]["translation"] = {0.25, 0, 0};
            std::ofstream(scene) << document;
        }
        return false;
    };
    const GlimRun done = runGlim(session);
    EXPECT_NE(done.err.find("loaded again"), std::string::npos) << done.err;
    const std::vector<std::string> options = printedOptions(done);
    ASSERT_EQ(options.size(), 1U) << done.out;
    EXPECT_GT(numberAfter("--at", options[0]), 0.0);
    const Film before = film(1), after = film(2), expected = renderAt(options[0]);
    EXPECT_FALSE(sameBits(before, after));
    EXPECT_TRUE(sameBits(after, expected));
}

// Where the controls are is known from a look at the window.
TEST_F(PreviewTimeTest, ThePanelChoosesAnimationAndTime)
{
    width = 640;
    height = 480;
    panels = true;
    const std::string chooses = "0 click 60,206\n0.1 click 60,241\n0.2 key C\n", scrubs = "0 drag left 20,229 90,229\n0.2 samples 2\n";
    const std::string playsToTheEnd = "0 click 61,275\n0 click 25,275\n2 samples 2\n0 key C\n", rests = "0 click 145,275\n0.2 key C\n";
    const GlimRun session = play(chooses + scrubs + "0 key C\n0 key P\n" + playsToTheEnd + rests);
    const std::vector<std::string> options = printedOptions(session);
    ASSERT_EQ(options.size(), 4U) << session.out;
    EXPECT_TRUE(options[0].ends_with(" --at 0 --animation 1")) << options[0];
    EXPECT_TRUE(options[1].ends_with(" --animation 1")) << options[1];
    EXPECT_NEAR(numberAfter("--at", options[1]), 0.5, 0.1);
    EXPECT_TRUE(sameBits(film(1), renderAt(options[1])));
    EXPECT_TRUE(options[2].ends_with(" --at 1 --animation 1")) << options[2];
    EXPECT_EQ(options[3], "--camera 0 --size 640x480 --environment 1,1,1") << "the rest pose";
}

TEST_F(PreviewTest, WithoutAnAnimationNothingPlays)
{
    const GlimRun session = run("0 samples 1\n0 key K\n0.2 samples 1\n0 key C\n0 close\n", {"--spp", "1"});
    EXPECT_EQ(firstLine(session.out), "--camera 0 --size 96x72");
}

// The lens is opened by the slider, so the panel shows.
TEST_F(PreviewTest, AClickFocusesTheLens)
{
    width = 640;
    height = 480;
    panels = true;
    const std::string pixel = "400,350";
    const GlimRun session =
        run("0 samples 1\n0 key O\n0 click " + pixel + "\n0 key C\n0 drag left 20,156 120,156\n0.2 samples 1\n0 key C\n0 key P\n0 close\n",
            {"--spp", "1"});
    const std::vector<std::string> options = printedOptions(session);
    ASSERT_EQ(options.size(), 2U) << session.out;
    EXPECT_EQ(options[0], "--camera 0 --size 640x480") << "a pinhole still, and no surface is chosen";
    const double radius = numberAfter("--lens-radius", options[1]);
    EXPECT_GT(radius, 0.0);
    const Film made = film(1), printed = render("--spp 1 " + options[1]);
    EXPECT_TRUE(sameBits(made, printed));
    const std::string lens = options[1].substr(options[1].find("--lens-radius"));
    EXPECT_TRUE(sameBits(made, render("--spp 1 --size 640x480 --focus " + pixel + " " + lens.substr(0, lens.find(" --focal")))));
    EXPECT_FALSE(sameBits(made, render("--spp 1")));
}

TEST_F(PreviewTest, TheSliderSetsTheFieldOfView)
{
    width = 640;
    height = 480;
    panels = true;
    const GlimRun session =
        run("0 samples 1\n0 drag left 20,133 60,133\n0.2 samples 1\n0 key C\n0 key P\n0 key F\n0.2 samples 1\n0 key C\n0 key P\n0 key R\n0 "
            "key C\n0 close\n",
            {"--spp", "1", "--zoom", "1.1"});
    const std::vector<std::string> options = printedOptions(session);
    ASSERT_EQ(options.size(), 3U) << session.out;
    EXPECT_NE(numberAfter("--zoom", options[0]), 1.1);
    EXPECT_EQ(numberAfter("--zoom", options[1]), numberAfter("--zoom", options[0])) << "F keeps it";
    EXPECT_EQ(options[2], "--camera 0 --zoom 1.1 --size 640x480");
    for (int i = 0; i < 2; ++i) {
        const Film made = film(1 + i), expected = render("--spp 1 " + options[static_cast<std::size_t>(i)]);
        EXPECT_TRUE(sameBits(made, expected)) << i;
        EXPECT_EQ(made.identity.settings, expected.identity.settings);
    }
}

TEST_F(PreviewTest, F11FillsTheScreenAndBack)
{
    run("0 samples 1\n0 key F11\n0.5 samples 1\n0 key P\n0 key F11\n0.5 samples 1\n0 key P\n0 close\n", {"--spp", "1"});
    EXPECT_TRUE(sameBits(film(1), render("--spp 1 --size 800x600")));
    EXPECT_TRUE(sameBits(film(2), render("--spp 1")));
}

}  // namespace
}  // namespace glim::test
