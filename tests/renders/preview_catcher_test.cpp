// The window shows objects and what they do to shadow catchers, and writes what `glim render` gives.
#include "host/render/aov.hpp"
#include "host/render/composite.hpp"
#include "host/render/film_file.hpp"
#include "tests/support/preview_fixture.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>

namespace glim::test {
namespace {

// The white walls catch the shadows of the spheres.
std::vector<std::string> catching(std::vector<std::string> options)
{
    options.insert(options.end(), {"--catcher", "white"});
    return options;
}

std::ptrdiff_t countClear(const Film& film)
{
    return std::ranges::count_if(pictureOf(film), [](const PixelMoments& pixel) { return pixel.alpha < 0.1F; });
}

TEST_F(PreviewTest, ShowsAndWritesWhatCatchersCatch)
{
    const Pixels shown = windowAtWriting(screen, "0 samples 8\n0 key P\n", catching({"--spp", "8"}));
    const Film expected = render("--spp 8 --catcher white");
    EXPECT_TRUE(sameBits(film(1), expected));
    EXPECT_EQ(film(1).identity.settings, expected.identity.settings);
    EXPECT_FALSE(film(1).showsBackground);
    EXPECT_TRUE(readFileBytes(folder / "cornell_spheres-001.png") == readFileBytes(folder / "r.png")) << "with its alpha";
    EXPECT_EQ(countOthers(shown, overCheckerboard(expected)), 0);
    EXPECT_GT(countClear(expected), 1000);
}

// Past the end of a page, where the host takes over the samples.
TEST_F(PreviewTest, ShowsManySamplesOfCatchers)
{
    width = 24;
    height = 18;
    const Pixels shown = windowAtWriting(screen, "0 samples 300\n0 key P\n", catching({"--spp", "300"}));
    const Film expected = render("--spp 300 --catcher white");
    EXPECT_TRUE(sameBits(film(1), expected));
    EXPECT_EQ(countOthers(shown, overCheckerboard(expected)), 0);
}

// Nor does a render denoise them.
TEST_F(PreviewTest, LeavesCatchersNoisyHoweverLongTheyRest)
{
    width = 24;
    height = 18;
    run("0 samples 1000\n5 key P\n0 close\n", catching({}));
    EXPECT_FALSE(film(1).catcher.empty());
    EXPECT_FALSE(readDenoised(folder / "cornell_spheres-001.exr"));
}

// Catchers are surfaces like others in all layers but the shaded one.
TEST_F(PreviewTest, MovesAndLayersOfCatchers)
{
    const GlimRun session =
        run("0 samples 1\n0 drag left 10,10 40,30\n0.1 key C\n0 samples 2\n0 key P\n0 key V\n0 key P\n0 click 48,60\n"
            "0 key V\n0 key V\n0 key V\n0 key V\n0 samples 2\n0 key P\n0 key V\n0 samples 2\n0 key P\n0 close\n",
            catching({"--spp", "2"}));
    const std::string options = "--spp 2 --catcher white " + firstLine(session.out);
    const Film shaded = render(options);
    EXPECT_TRUE(sameBits(film(1), shaded));
    EXPECT_TRUE(readFileBytes(folder / "cornell_spheres-001.png") == readFileBytes(folder / "r.png"));
    render(options + " --view normal --environment-background off");
    EXPECT_TRUE(readFileBytes(folder / "cornell_spheres-002.png") == readFileBytes(folder / "r.png"));
    EXPECT_NE(session.out.find("; 2 samples, mean ("), std::string::npos) << session.out;
    EXPECT_TRUE(sameBits(film(3), render(options + " --view bvh-steps")));
    EXPECT_EQ(picture(3), rendered());
    EXPECT_TRUE(sameBits(film(4), shaded)) << "round again";
}

TEST_F(PreviewTest, AGuidedViewHasCatchers)
{
    width = 24;
    height = 18;
    run("0 samples 8\n0 key P\n0 close\n", catching({"--spp", "8", "--guiding", "on"}));
    const Film expected = render("--spp 8 --catcher white --guiding on");
    EXPECT_TRUE(sameBits(film(1), expected));
    EXPECT_NE(findSetting(film(1).identity.settings, "guide"), "");
    EXPECT_FALSE(film(1).catcher.empty());
}

// A file that is saved with a catcher, and then without.
TEST_F(PreviewTest, AChangedFileHasCatchersOrNot)
{
    const nlohmann::json plain = nlohmann::json::parse(std::ifstream(scene));
    nlohmann::json catcher = plain;
    catcher["materials"][0]["extras"]["shadowCatcher"] = true;
    scene = folder / "room.gltf";
    const auto save = [this](const nlohmann::json& document) { std::ofstream(scene) << document; };
    const auto pressP = [this] {
        EXPECT_EQ(std::system(("DISPLAY=" + screen.name() + " xdotool mousemove 48 36 key p").c_str()), 0)
            << "is the package xdotool installed?";
    };
    struct Stage {
        const char* waitsFor;
        std::function<void()> then;
    };
    const std::vector<Stage> stages{{"wrote room-001", [&] { save(catcher); }},
                                    {"is loaded again", pressP},
                                    {"wrote room-002", [&] { save(plain); }},
                                    {"is loaded again", pressP},
                                    {"wrote room-003", [] {}}};
    save(plain);
    GlimCall session = call("0 samples 1\n0 key P\n", {"--spp", "1"});
    std::size_t stage = 0, read = 0;
    session.signalWhen = [&](const std::string& err) {
        if (err.find(stages[stage].waitsFor, read) != std::string::npos) {
            read = err.size();
            stages[stage++].then();
        }
        return stage == stages.size();
    };
    session.signal = SIGTERM;
    const GlimRun done = runGlim(session);
    ASSERT_EQ(stage, stages.size()) << done.err;
    const Film expected = render("--spp 1");
    EXPECT_TRUE(sameBits(film(1), expected));
    EXPECT_TRUE(sameBits(film(3), expected));
    EXPECT_TRUE(sameBits(film(2), render("--spp 1 --catcher white")));
}

}  // namespace
}  // namespace glim::test
