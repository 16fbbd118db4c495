// The window, on a screen of the test's own: scripted sessions, what is on the screen, and what is written.
#include "host/render/film_file.hpp"
#include "tests/support/decode_png.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/virtual_screen.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <sstream>
#include <thread>

namespace glim::test {
namespace {

using Pixels = std::vector<std::array<int, 3>>;

constexpr std::uint32_t kWidth = 96, kHeight = 72;

class PreviewTest : public testing::Test {
protected:
    // `glim preview` of scenes/cornell_spheres.gltf with the steps of `script`, one per line, in a folder of its own.
    GlimCall call(const std::string& script, const std::vector<std::string>& more = {}) const
    {
        std::ofstream(folder / "script") << script;
        GlimCall made;
        made.arguments = {"preview", sceneFile("cornell_spheres.gltf"), "--size", size, "--script", "script"};
        made.arguments.insert(made.arguments.end(), more.begin(), more.end());
        made.environment["DISPLAY"] = screen.name();
        made.environment["GLIM_VALIDATION"] = "1";
        made.folder = folder.path();
        return made;
    }
    GlimRun run(const std::string& script, const std::vector<std::string>& more = {}) const { return run(call(script, more)); }
    static GlimRun run(const GlimCall& made)
    {
        const GlimRun done = runGlim(made);
        EXPECT_EQ(done.exitCode, 0) << done.err;
        EXPECT_EQ(done.err.find("validation"), std::string::npos) << done.err;
        return done;
    }

    // What `glim render` makes of the same scene; `options` separated by blanks.
    Film render(const std::string& options) const
    {
        GlimCall made;
        made.arguments = {"render", sceneFile("cornell_spheres.gltf"), "-o", "r.exr", "--png", "r.png", "--size", size};
        std::istringstream words(options);
        for (std::string word; words >> word;) {
            made.arguments.push_back(word);
        }
        made.folder = folder.path();
        EXPECT_EQ(runGlim(made).exitCode, 0) << options;
        return readFilm(folder / "r.exr");
    }
    Film written(int number) const { return readFilm(folder / ("cornell_spheres-00" + std::to_string(number) + ".exr").c_str()); }
    Pixels picture(int number) const { return decodePng(folder / ("cornell_spheres-00" + std::to_string(number) + ".png").c_str()); }

    ScratchFolder folder;
    VirtualScreen screen;
    std::string size = "96x72";
};

Pixels cornerOf(const Pixels& screen, std::uint32_t width, std::uint32_t height)
{
    Pixels corner;
    for (std::size_t y = 0; y < height; ++y) {
        const auto row = screen.begin() + static_cast<std::ptrdiff_t>(y * VirtualScreen::kWidth);
        corner.insert(corner.end(), row, row + width);
    }
    return corner;
}

// How many pixels differ by more than one step of eight bits in a channel, which rounding in float and double may.
int countOthers(const Pixels& a, const Pixels& b)
{
    int others = 0;
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
        bool same = true;
        for (std::size_t c = 0; c < 3; ++c) {
            same = same && std::abs(a[i][c] - b[i][c]) <= 1;
        }
        others += same ? 0 : 1;
    }
    return a.size() == b.size() ? others : -1;
}

// Figures and help are switched off, so that all of the window is picture.
TEST_F(PreviewTest, ShowsAndWritesWhatARenderGives)
{
    Pixels shown;
    GlimCall session = call("0 key H\n0 key H\n0 samples 8\n0 key P\n", {"--spp", "8"});
    session.signalWhen = [&](const std::string& err) {
        if (err.find("wrote cornell_spheres-001") == std::string::npos) {
            return false;
        }
        shown = screen.calmPixels();
        return true;
    };
    session.signal = SIGTERM;
    EXPECT_EQ(runGlim(session).signal, SIGTERM);
    const Film film = render("--spp 8");
    EXPECT_TRUE(sameBits(written(1), film));
    EXPECT_EQ(bytesOfFile(folder / "cornell_spheres-001.png"), bytesOfFile(folder / "r.png"));
    EXPECT_EQ(countOthers(cornerOf(shown, kWidth, kHeight), decodePng(folder / "r.png")), 0);
}

// Through a page's end, where the host takes the samples, and beyond.
TEST_F(PreviewTest, ShowsManySamples)
{
    Pixels shown;
    size = "24x18";
    GlimCall session = call("0 key H\n0 key H\n0 samples 300\n0 key P\n", {"--spp", "300"});
    session.signalWhen = [&](const std::string& err) {
        if (err.find("wrote") == std::string::npos) {
            return false;
        }
        shown = screen.calmPixels();
        return true;
    };
    session.signal = SIGTERM;
    runGlim(session);
    EXPECT_TRUE(sameBits(written(1), render("--spp 300")));
    EXPECT_EQ(countOthers(cornerOf(shown, 24, 18), picture(1)), 0);
}

// Wherever the camera was moved to, C prints the options of `glim render` that give the same bits.
TEST_F(PreviewTest, PrintsTheOptionsOfItsCamera)
{
    const char* const kMoves[] = {
        "0 drag left 10,10 40,30\n",
        "0 drag middle 50,50 20,40\n0 scroll 2\n",
        "0 key F\n0 scroll -1\n",
        "0 press W\n0.2 release W\n0 press E\n0 press A\n0.1 release A\n0 release E\n",
        "0 key F\n0 drag left 0,0 90,0\n0 key R\n",
    };
    for (const char* moves : kMoves) {
        const GlimRun session = run(std::string("0 samples 1\n") + moves + "0.1 key C\n0 samples 4\n0 key P\n0 key escape\n", {"--spp", "4"});
        const std::string options = session.out.substr(0, session.out.find('\n'));
        ASSERT_EQ(options.rfind("--camera 0", 0), 0U) << session.out;
        EXPECT_NE(session.out.find("\"cameras\":[{\"type\":\"perspective\""), std::string::npos) << session.out;
        EXPECT_TRUE(sameBits(written(1), render("--spp 4 " + options))) << moves << options;
        std::filesystem::remove(folder / "cornell_spheres-001.exr");
        std::filesystem::remove(folder / "cornell_spheres-001.png");
    }
}

TEST_F(PreviewTest, KeysDoWhatTheHelpSays)
{
    std::string script = "0 samples 4\n0 key P\n";
    for (int views = 0; views < 6; ++views) {
        script += "0 key V\n0 samples 4\n0 key P\n";
    }
    script += "0 key +\n0 key P\n0 key -\n0 key P\n0 key 2\n0 click 48,36\n0 key H\n0 key space\n0 close\n";
    const GlimRun session = run(script, {"--spp", "4"});
    render("--spp 4");
    const Pixels shaded = decodePng(folder / "r.png");
    const char* const kViews[] = {"normal", "depth", "albedo"};
    EXPECT_EQ(picture(1), shaded);
    for (int i = 0; i < 3; ++i) {
        render(std::string("--spp 4 --view ") + kViews[i]);
        EXPECT_EQ(picture(2 + i), decodePng(folder / "r.png")) << kViews[i];
    }
    EXPECT_EQ(picture(5), Pixels(kWidth * kHeight, {0, 0, 255})) << "as many samples everywhere";
    const Film steps = render("--spp 4 --view bvh-steps");
    EXPECT_EQ(picture(6), decodePng(folder / "r.png"));
    EXPECT_TRUE(sameBits(written(6), steps));
    EXPECT_EQ(picture(7), shaded) << "round again";
    render("--spp 4 --exposure 0.5");
    EXPECT_EQ(picture(8), decodePng(folder / "r.png"));
    EXPECT_EQ(picture(9), shaded);
    EXPECT_NE(session.out.find("pixel (48, 36) of 96x72: mesh "), std::string::npos) << session.out;
    EXPECT_NE(session.out.find("; 4 samples, mean ("), std::string::npos) << session.out;
}

TEST_F(PreviewTest, PauseStopsSampling)
{
    const GlimRun session = run("0 samples 2\n0 key space\n0.1 key P\n0.5 key P\n0 key space\n0.5 key P\n0 close\n");
    EXPECT_TRUE(sameBits(written(1), written(2))) << session.err;
    EXPECT_GT(written(3).pixels[0].count, written(2).pixels[0].count);
}

TEST_F(PreviewTest, SurvivesAResizeStorm)
{
    std::ostringstream script;
    script << "0 samples 1\n";
    for (int i = 0; i < 100; ++i) {
        script << "0.01 resize " << 20 + 7 * (i % 30) << "x" << 300 - 9 * (i % 32) << "\n";
    }
    script << "0.1 resize 64x48\n0.1 samples 2\n0 key P\n0 iconify\n0.1 restore\n0 close\n";
    run(script.str(), {"--spp", "2"});
    size = "64x48";
    EXPECT_TRUE(sameBits(written(1), render("--spp 2")));
}

TEST_F(PreviewTest, ClosesWhileItLoads)
{
    run("0 close\n");
    run("0.05 key V\n0 drag left 1,1 30,30\n0 key P\n0 key C\n0 click 3,3\n0 close\n");
}

TEST_F(PreviewTest, EndsAfterItsFrames) { EXPECT_NE(run("", {"--frames", "3"}).err.find("glim: 3 frames"), std::string::npos); }

// A script that asks for a response 30 times: each is in a picture, and how long that took is said.
TEST_F(PreviewTest, SaysHowFastItResponds)
{
    std::string script = "0 samples 1\n";
    for (int i = 0; i < 30; ++i) {
        script += "0.02 drag left 10,10 20,14\n";
    }
    const std::string err = run(script + "0.3 close\n").err;
    EXPECT_NE(err.find(" inputs, each in a picture after "), std::string::npos) << err;
}

TEST_F(PreviewTest, LoadsAChangedSceneAgainAndABrokenOneNot)
{
    std::filesystem::copy_file(sceneFile("cornell_spheres.gltf"), folder / "cornell_spheres.gltf");
    const std::filesystem::path data = std::filesystem::path(sceneFile("cornell_spheres.gltf")).parent_path();
    for (const auto& entry : std::filesystem::directory_iterator(data)) {
        if (entry.path().extension() == ".bin") {
            std::filesystem::copy_file(entry.path(), folder / entry.path().filename().c_str());
        }
    }
    GlimCall session = call("0 samples 1\n0 key P\n");
    session.arguments[1] = "cornell_spheres.gltf";
    int stage = 0;
    session.signalWhen = [&](const std::string& err) {
        const char* const kWaitsFor[] = {"wrote cornell_spheres-001", "cornell_spheres.gltf: ", "has changed and is loaded again"};
        if (err.find(kWaitsFor[stage]) == std::string::npos) {
            return false;
        }
        const std::string good = bytesOfFile(sceneFile("cornell_spheres.gltf"));
        std::ofstream(folder / "cornell_spheres.gltf") << (stage == 0 ? std::string("{\"broken\"") : good);
        return ++stage == 3;
    };
    session.signal = SIGTERM;
    EXPECT_EQ(runGlim(session).signal, SIGTERM);
    EXPECT_EQ(stage, 3) << "the old picture stays, then the mended scene comes";
}

TEST_F(PreviewTest, RefusesWhatItCannotShow)
{
    const auto refusal = [&](GlimCall session, int exitCode, const char* sentence) {
        const GlimRun done = runGlim(session);
        EXPECT_EQ(done.exitCode, exitCode) << done.err;
        EXPECT_NE(done.err.find(sentence), std::string::npos) << done.err;
    };
    GlimCall blind = call("");
    blind.environment["DISPLAY"] = std::nullopt;
    blind.environment["WAYLAND_DISPLAY"] = std::nullopt;
    refusal(blind, 1, "`glim render`");
    blind.environment["DISPLAY"] = ":4711";
    refusal(blind, 1, "`glim render`");
    refusal(call("0 jump\n"), 1, "script, line 1: \"0 jump\": expected a delay");
    GlimCall missing = call("");
    missing.arguments[1] = "missing.gltf";
    refusal(missing, 1, "missing.gltf");
    GlimCall camera = call("");
    camera.arguments.insert(camera.arguments.end(), {"--camera", "seven"});
    refusal(camera, 1, "camera \"seven\"");
}

}  // namespace
}  // namespace glim::test
