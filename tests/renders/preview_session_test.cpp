// What a user does in the window, and what it answers.
#include "host/image/exr.hpp"
#include "places.h"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/preview_fixture.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

namespace glim::test {
namespace {

TEST_F(PreviewTest, ViewsExposureAndClicks)
{
    std::string script = "0 samples 4\n0 key P\n";
    for (int views = 0; views < 7; ++views) {
        script += "0 key V\n0 samples 4\n0 key P\n";
    }
    script += "0 key +\n0 key P\n0 key -\n0 key P\n0 click 48,36\n0 close\n";
    const GlimRun session = run(script, {"--spp", "4"});
    render("--spp 4");
    const Pixels shaded = rendered();
    const char* const kViews[] = {"normal", "depth", "albedo"};
    EXPECT_EQ(picture(1), shaded);
    for (int i = 0; i < 3; ++i) {
        render(std::string("--spp 4 --view ") + kViews[i]);
        EXPECT_EQ(picture(2 + i), rendered()) << kViews[i];
    }
    EXPECT_EQ(picture(5), Pixels(std::size_t{width} * height, {0, 0, 255})) << "as many samples everywhere";
    const Film steps = render("--spp 4 --view bvh-steps");
    EXPECT_EQ(picture(6), rendered());
    EXPECT_TRUE(sameBits(film(6), steps));
    EXPECT_EQ(picture(7), shaded) << "of which the window shows the error";
    EXPECT_EQ(picture(8), shaded) << "round again";
    render("--spp 4 --exposure 0.5");
    EXPECT_EQ(picture(9), rendered());
    EXPECT_EQ(picture(10), shaded);
    EXPECT_NE(session.out.find("pixel (48, 36) of 96x72: instance "), std::string::npos) << session.out;
    EXPECT_NE(session.out.find("; 4 samples, mean ("), std::string::npos) << session.out;
}

// Films of every camera are those of a render, and a click finds what the pixel's centre shows.
TEST_F(PreviewTest, EveryProjection)
{
    for (const char* const options : {"--projection equirectangular", "--fisheye 0.1,0,0,0", "--shift 0.1,-0.2",
                                      "--intrinsics 90,80,50,30 --distortion -0.2,0.05,0.01,0"}) {
        const std::string inside = std::string("--look-from 0,1,0 --look-at 0,1,-1 --look-up 0,1,0 ") + options;
        std::istringstream words(inside + " --spp 1");
        const std::vector<std::string> more{std::istream_iterator<std::string>(words), {}};
        const GlimRun session = run("0 samples 1\n0 click 20,50\n0 key P\n0 key C\n0 close\n", more);
        const Film expected = render(inside + " --spp 1 --surfaces " + (folder / "s.exr").string());
        EXPECT_TRUE(sameBits(film(1), expected)) << options;
        EXPECT_NE(session.out.find("--camera 0 " + inside), std::string::npos) << session.out;
        const Image surfaces = readExr(folder / "s.exr");
        const std::size_t pixel = std::size_t{50} * width + 20, at = session.out.find(", at (");
        ASSERT_NE(at, std::string::npos) << session.out;
        std::array<double, 4> found{};
        ASSERT_EQ(std::sscanf(session.out.c_str() + at, ", at (%lf, %lf, %lf), %lf m", &found[0], &found[1], &found[2], &found[3]), 4);
        const char* const kChannels[] = {"position.X", "position.Y", "position.Z", "distance.Y"};
        for (std::size_t k = 0; k < 4; ++k) {
            EXPECT_NEAR(found[k], static_cast<double>(surfaces.channels.at(kChannels[k])[pixel]), 2e-5)
                << options;  // six digits are printed
        }
        removePictures();
    }
}

// Through GLFW and X: real keys, drags and turns of the wheel do what the scripts' do.
TEST_F(PreviewTest, KeyboardAndMouseOfTheScreen)
{
    GlimCall session = call("", {"--spp", "1"});
    std::string command =
        "DISPLAY=" + screen.name() + " timeout 60 xdotool search --sync --onlyvisible --name '^glim: cornell_spheres.gltf$'";
    command +=
        " mousemove 48 36 click 1 key c"
        " mousemove 30 30 mousedown 1 mousemove 60 40 mouseup 1 key c"
        " mousemove 30 30 keydown Shift mousedown 1 mousemove 50 40 mouseup 1 keyup Shift key c"
        " mousemove 30 30 mousedown 2 mousemove 10 20 mouseup 2 key c"
        " click 4 key c click 5 key c keydown w sleep 0.3 keyup w key c key plus key minus key plus key p";
    std::thread hand([&command] { EXPECT_EQ(std::system(command.c_str()), 0) << "is the package xdotool installed?"; });
    session.signalWhen = [&](const std::string& err) {
        return err.find("wrote") != std::string::npos && std::system(("DISPLAY=" + screen.name() + " xdotool key Escape").c_str()) == 0;
    };
    session.signal = 0;  // none: Escape is enough
    const GlimRun done = runGlim(session);
    hand.join();
    EXPECT_EQ(done.exitCode, 0) << done.err;
    EXPECT_NE(done.out.find("pixel (48, 36) of 96x72: instance "), std::string::npos) << done.out;
    std::istringstream out(done.out);
    std::vector<std::string> views;
    for (std::string line; std::getline(out, line);) {
        if (line.starts_with("--camera")) {
            views.push_back(line);
        }
    }
    ASSERT_EQ(views.size(), 7U) << done.out;
    EXPECT_EQ(views[0], "--camera 0 --size 96x72") << "a click moves nothing";
    for (std::size_t i = 1; i < views.size(); ++i) {
        EXPECT_NE(views[i], views[i - 1]) << i;
    }
    const auto lookedAt = [&views](std::size_t i) { return views[i].substr(std::min(views[i].size(), views[i].find("--look-at"))); };
    EXPECT_NE(lookedAt(2), lookedAt(1)) << "pans with shift";
    EXPECT_NE(lookedAt(3), lookedAt(2)) << "pans with the middle button";
    EXPECT_EQ(lookedAt(4), lookedAt(3)) << "the wheel goes nearer";
    render(views.back() + " --spp 1 --exposure 0.5");
    EXPECT_EQ(picture(1), rendered());
}

glm::dvec3 standsAt(const std::string& options)
{
    glm::dvec3 at(0.0);
    const std::size_t place = options.find("--look-from ");
    EXPECT_NE(place, std::string::npos) << options;
    std::sscanf(options.c_str() + std::min(place, options.size()), "--look-from %lf,%lf,%lf", &at.x, &at.y, &at.z);
    return at;
}

// The camera of the scene looks along -Z; half the scene's radius a second.
TEST_F(PreviewTest, KeysFly)
{
    const std::vector<std::pair<char, glm::dvec3>> kWays{{'W', {0, 0, -1}}, {'S', {0, 0, 1}},  {'A', {-1, 0, 0}},
                                                         {'D', {1, 0, 0}},  {'Q', {0, -1, 0}}, {'E', {0, 1, 0}}};
    std::string script = "0 samples 1\n0 drag left 10,10 20,10\n0 drag left 20,10 10,10\n0 key C\n";
    for (const auto& [key, way] : kWays) {
        script += std::string("0 press ") + key + "\n0.3 release " + key + "\n0 key C\n";
    }
    std::istringstream out(run(script + "0 key R\n0 key C\n0 key F\n0 key C\n0 key escape\n").out);
    const auto nextLine = [&] {
        std::string line, gltf;
        std::getline(out, line);
        std::getline(out, gltf);
        return line;
    };
    glm::dvec3 before = standsAt(nextLine());
    for (const auto& [key, way] : kWays) {
        const glm::dvec3 now = standsAt(nextLine());
        const double distance = glm::length(now - before);
        EXPECT_GT(distance, 0.02) << key;
        EXPECT_LT(glm::length(now - before - distance * way), 1e-3 * distance) << key;
        before = now;
    }
    EXPECT_EQ(nextLine(), "--camera 0 --size 96x72") << "after R";
    EXPECT_GT(standsAt(nextLine()).z, before.z) << "after F";
}

TEST_F(PreviewTest, DigitsAreTheFilesCameras)
{
    nlohmann::json document = nlohmann::json::parse(std::ifstream(scene));
    document["nodes"].push_back({{"camera", 0}, {"translation", {0.3, 1.2, 2.0}}});
    document["scenes"][0]["nodes"].push_back(document["nodes"].size() - 1);
    scene = folder / "two.gltf";
    std::ofstream(scene) << document;
    const GlimRun session =
        run("0 samples 2\n0 key 2\n0 samples 2\n0 key C\n0 key P\n0 key 1\n0 samples 2\n0 key P\n0 key 3\n"
            "0 key P\n0 close\n",
            {"--spp", "2"});
    EXPECT_EQ(firstLine(session.out), "--camera 1 --size 96x72");
    EXPECT_TRUE(sameBits(film(1), render("--spp 2 --camera 1")));
    const Film first = render("--spp 2");
    EXPECT_TRUE(sameBits(film(2), first));
    EXPECT_TRUE(sameBits(film(3), first)) << "there is no camera 3";
}

TEST_F(PreviewTest, PanelsAndHelpComeAndGo)
{
    width = 640;
    height = 480;
    panels = true;
    const auto covered = [&](const std::string& keys) {
        const Pixels window = windowAtWriting(screen, "0 samples 1\n" + keys + "0 key P\n", {"--spp", "1"});
        const int others = countOthers(window, picture(1));
        removePictures();
        return others;
    };
    const int controls = covered(""), help = covered("0 key H\n"), bare = covered("0 key H\n0 key H\n");
    EXPECT_GT(controls, 100 * 100);
    EXPECT_GT(help, 1.5 * controls);
    EXPECT_EQ(bare, 0);
}

// Where the controls are is known from a look at the window. Keys do the same.
TEST_F(PreviewTest, ControlsOfThePanelsDoWhatTheKeysDo)
{
    width = 320;
    height = 240;
    panels = true;
    const auto session = [&](const std::string& steps) {
        run("0 samples 1\n" + steps + "0.1 samples 1\n0 key P\n0 close\n", {"--spp", "1"});
        const Pixels made = picture(1);
        removePictures();
        return made;
    };
    const auto expected = [&](const std::string& look) {
        render("--spp 1 " + look);
        return rendered();
    };
    EXPECT_EQ(session("0 drag left 90,37 0,37\n"), expected("--exposure -10")) << "the slider to its end, and no orbit";
    EXPECT_EQ(session("0 click 60,60\n0.1 click 60,112\n"), expected("--tone agx")) << "the third of the tones";
    EXPECT_EQ(session("0 click 60,83\n0.1 click 60,124\n"), expected("--view normal")) << "the second of the layers";
    EXPECT_EQ(session("0 key T\n"), expected("--tone neutral"));
    EXPECT_EQ(session("0 key T\n0 key T\n0 key T\n0 key V\n"), expected("--view normal"));
}

// A surface that is clicked is changed in the panel. What C prints and J saves renders the same, and Z undoes it.
TEST_F(PreviewTest, ThePanelChangesTheSurfaceThatWasClicked)
{
    width = 640;
    height = 320;
    panels = true;
    const GlimRun session =
        run("0 samples 1\n0 click 460,160\n0.2 drag left 20,259 240,259\n0.2 samples 1\n0 key C\n0 key J\n0 key P\n"
            "0.2 key Z\n0.2 samples 1\n0 key P\n0 close\n",
            {"--spp", "1"});
    const std::size_t option = session.out.find(" --set /materials/");
    ASSERT_NE(option, std::string::npos) << session.out << session.err;
    const std::string set = session.out.substr(option + 1, session.out.find('\n', option) - option - 1);
    EXPECT_TRUE(set.ends_with("/pbrMetallicRoughness/metallicFactor=1")) << set;
    const Film plain = render("--spp 1"), changed = render("--spp 1 " + set);
    EXPECT_FALSE(sameBits(plain, changed));
    EXPECT_TRUE(sameBits(film(1), changed));
    EXPECT_TRUE(sameBits(film(2), plain));
    EXPECT_TRUE(sameBits(changed, render("--spp 1 --edits cornell_spheres-001.edits.json")));
}

TEST_F(PreviewTest, PauseStopsSampling)
{
    width = 24;
    height = 18;
    const GlimRun session = run("0 samples 2\n0 key space\n0.1 key P\n0.5 key P\n0 key space\n0 samples 8192\n0 key P\n0 close\n");
    EXPECT_TRUE(sameBits(film(1), film(2))) << session.err;
    EXPECT_GT(film(3).pixels[0].count, film(2).pixels[0].count);
}

// P right after a move waits for a picture of the whole window with a sample everywhere.
TEST_F(PreviewTest, WritesNoUnfinishedPicture)
{
    run("0 samples 1\n0 drag left 10,10 40,20\n0 key P\n0 samples 1\n0 close\n");
    const Film whole = film(1);
    EXPECT_EQ(whole.width, width);
    EXPECT_TRUE(std::all_of(whole.pixels.begin(), whole.pixels.end(), [](const PixelMoments& pixel) { return pixel.count > 0; }));
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
    width = 64;
    height = 48;
    EXPECT_TRUE(sameBits(film(1), render("--spp 2")));
}

TEST_F(PreviewTest, ClosesWhileItLoads)
{
    run("0 close\n");
    run("0.05 key V\n0 drag left 1,1 30,30\n0 key P\n0 key C\n0 click 3,3\n0 close\n");
}

TEST_F(PreviewTest, EndsAfterItsFrames)
{
    EXPECT_NE(run("", {"--frames", "20", "--spp", "1"}).err.find("glim: 20 frames"), std::string::npos);
}

// The session that host/preview/README.md measures: whatever the user does, a picture answers it.
TEST_F(PreviewTest, AnswersEveryInput)
{
    width = 640;
    height = 480;
    panels = true;
    const GlimRun session = run(readFileBytes(GLIM_SOURCE_DIR "/tests/renders/look_around.script"));
    int frames = 0, inputs = 0, median = -1, most = -1;
    const std::size_t last = session.err.rfind("glim: ");
    ASSERT_NE(last, std::string::npos) << session.err;
    EXPECT_EQ(std::sscanf(session.err.c_str() + last, "glim: %d frames; %d inputs, from input to picture %d ms (median), %d ms (99 %%)",
                          &frames, &inputs, &median, &most),
              4)
        << session.err;
    EXPECT_GE(inputs, 200);
    EXPECT_GT(median, 0);
    EXPECT_GE(most, median);
}

// The glTF file and its buffer: an exporter writes both, one after the other.
TEST_F(PreviewTest, LoadsAChangedSceneAgainAndABrokenOneNot)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    nlohmann::json document = builder.document;
    document["buffers"] = {{{"byteLength", builder.bytes().size()}, {"uri", "data.bin"}}};
    nlohmann::json late = document;
    late["buffers"][0]["uri"] = "late.bin";
    scene = folder / "triangle.gltf";
    const auto writeBuffer = [&](const char* name) {
        const Bytes bytes = builder.bytes();
        std::ofstream(folder / name, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
    };
    writeBuffer("data.bin");
    std::ofstream(scene) << document.dump();
    struct Stage {
        const char* waitsFor;
        std::function<void()> then;
    };
    const std::vector<Stage> stages{
        {"wrote triangle-001", [&] { std::ofstream(scene) << "{\"broken\""; }},
        {"triangle.gltf: ", [&] { std::ofstream(scene) << document.dump(); }},
        {"is loaded again", [&] { writeBuffer("data.bin"); }},
        {"is loaded again", [&] { std::ofstream(scene) << late.dump(); }},
        {"late.bin", [&] { writeBuffer("late.bin"); }},
        {"is loaded again", [] {}},
    };
    GlimCall session = call("0 samples 1\n0 key P\n", {"--environment", "1,1,1"});
    std::size_t stage = 0, read = 0;
    session.signalWhen = [&](const std::string& err) {
        const std::size_t place = err.find(stages[stage].waitsFor, read);
        if (place != std::string::npos) {
            read = err.size();
            stages[stage++].then();
        }
        return stage == stages.size();
    };
    session.signal = SIGTERM;
    const GlimRun done = runGlim(session);
    EXPECT_EQ(done.signal, SIGTERM) << done.err;
    EXPECT_EQ(stage, stages.size()) << done.err;
}

TEST_F(PreviewTest, RefusesWhatItCannotShow)
{
    panels = true;
    const auto refused = [](const GlimCall& session, MessageId id, const Parts& parts = {}) {
        expectRefused(runForMessages(session), 1, id, parts);
    };
    GlimCall blind = call("");
    blind.environment["DISPLAY"] = std::nullopt;
    blind.environment["WAYLAND_DISPLAY"] = std::nullopt;
    refused(blind, MessageId::NoWindow);
    blind.environment["DISPLAY"] = ":4711";
    refused(blind, MessageId::NoWindow);
    refused(call("0 jump\n"), MessageId::Malformed, {.file = "script", .place = "line 1", .value = "0 jump"});
    for (const int depth : {8, 16}) {
        const VirtualScreen colours(depth);
        GlimCall dim = call("");
        dim.environment["DISPLAY"] = colours.name();
        refused(dim, MessageId::NoWindow);
    }
    GlimCall missing = call("");
    missing.arguments[1] = "missing.gltf";
    refused(missing, MessageId::FileMissing, {.file = "missing.gltf"});
    GlimCall camera = call("");
    camera.arguments.insert(camera.arguments.end(), {"--camera", "seven"});
    refused(camera, MessageId::UnknownName, {.place = "camera", .value = "seven"});
    GlimCall nowhere = call("");
    nowhere.arguments.insert(nowhere.arguments.end(), {"--look-from", "0,0,0", "--look-at", "0,0,0"});
    refused(nowhere, MessageId::Degenerate, {.place = "--look-at"});
}

}  // namespace
}  // namespace glim::test
