// Kernels from a folder of shaders: the window takes those that are saved, and keeps its picture while one is broken.
#include "tests/support/expect_message.hpp"
#include "tests/support/preview_fixture.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>

namespace glim::test {
namespace {

class PreviewShadersTest : public PreviewTest {
protected:
    PreviewShadersTest()
    {
        std::filesystem::copy(GLIM_SOURCE_DIR "/shaders", folder / "shaders", std::filesystem::copy_options::recursive);
    }

    // What a user does, and what stderr says after that.
    struct Step {
        std::function<void()> act;
        std::string answer;
        std::function<void()> look;
    };
    // The steps by turns, in a session that shows one sample of each pixel.
    void play(const std::vector<Step>& steps) const
    {
        GlimCall session = call("", {"--spp", "1", "--shaders", "shaders"});
        std::size_t next = 0, said = 0;
        session.signalWhen = [&](const std::string& err) {
            if (next > 0) {
                const std::size_t found = err.find(steps[next - 1].answer, said);
                if (found == std::string::npos) {
                    return false;
                }
                said = found + steps[next - 1].answer.size();
                steps[next - 1].look();
            }
            if (next < steps.size()) {
                steps[next].act();
            }
            return next++ == steps.size();
        };
        session.signal = SIGTERM;
        const GlimRun done = runGlim(session);
        EXPECT_EQ(done.signal, SIGTERM) << done.err;
        EXPECT_EQ(next, steps.size() + 1) << done.err;
        EXPECT_FALSE(contains(done.err, "validation")) << done.err;
    }
    // As in "v v p".
    void press(const std::string& keys) const
    {
        const std::string window = " timeout 60 xdotool search --sync --onlyvisible --name '^glim: cornell_spheres.gltf$'";
        EXPECT_EQ(std::system(("DISPLAY=" + screen.name() + window + " key " + keys).c_str()), 0) << "is the package xdotool installed?";
    }
    // The key P after others, and the film that it has written.
    Step writes(int number, std::function<void(const Film& film)> look, const std::string& before = "") const
    {
        return {[this, before] { press(before + "p"); }, "wrote cornell_spheres-00" + std::to_string(number),
                [this, number, look] { look(film(number)); }};
    }
    Pixels windowNow() const { return windowOf(screen.calmPixels()); }
    // For a minute at most.
    void awaitWindow(const Pixels& expected) const
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (windowNow() != expected && std::chrono::steady_clock::now() < end) {
        }
        EXPECT_EQ(countOthers(windowNow(), expected), 0);
    }

    // In a file of the folder.
    void replace(const std::string& file, const std::string& text, const std::string& by) const
    {
        const std::filesystem::path path = folder / "shaders" / file;
        std::string content = readFileBytes(path);
        const std::size_t at = content.find(text);
        ASSERT_NE(at, std::string::npos) << file << " has no " << text;
        writeText(path, content.replace(at, text.size(), by));
    }
};

const std::string kTaken = "glim: the kernels of shaders have changed";
const std::string kAccumulate = "kernels/accumulate.comp", kAdd = "return addSample(",
                  kAddRed = "path.radiance.gb = vec2(0.0); return addSample(";

Pixels onlyRed(Pixels pixels)
{
    std::ranges::for_each(pixels, [](auto& pixel) { pixel[1] = pixel[2] = 0; });
    return pixels;
}

TEST_F(PreviewShadersTest, SavedKernelsShowAndBrokenOnesDoNot)
{
    Pixels own, red;
    Film ownFilm;
    std::string redSettings;
    play({writes(1,
                 [&](const Film& film) {
                     own = picture(1);
                     awaitWindow(own);
                     ownFilm = film;
                     EXPECT_EQ(findSetting(film.identity.settings, "shaders"), "") << "a copy of glim's own";
                     EXPECT_NE(onlyRed(own), own);
                 }),
          {[&] { replace(kAccumulate, kAdd, kAddRed); }, kTaken, [] {}},
          writes(2,
                 [&](const Film& film) {
                     red = onlyRed(own);
                     awaitWindow(red);
                     EXPECT_EQ(picture(2), red);
                     redSettings = film.identity.settings;
                     EXPECT_NE(findSetting(redSettings, "shaders"), "");
                     EXPECT_NE(film.identity.kernels, ownFilm.identity.kernels);
                 }),
          {[&] { replace("lib/moments.glsl", "\n", "\nint broken = nothing;\n"); },
           "glim: shaders/lib/moments.glsl:2: error: 'nothing' : undeclared identifier\n", [&] { EXPECT_EQ(windowNow(), red); }},
          {[&] { replace("lib/moments.glsl", "nothing", "1.0"); }, "glim: shaders/lib/moments.glsl:2: error: '=' :  cannot convert",
           [&] { EXPECT_EQ(windowNow(), red); }},
          {[&] {
               replace("lib/moments.glsl", "\nint broken = 1.0;\n", "\n");
               replace(kAccumulate, kAddRed, kAdd);
           },
           kTaken, [] {}},
          writes(3, [&](const Film& film) {
              awaitWindow(own);
              EXPECT_TRUE(sameBits(film, ownFilm));
              EXPECT_EQ(film.identity.settings, ownFilm.identity.settings);
              EXPECT_EQ(film.identity.kernels, ownFilm.identity.kernels);
          })});
    EXPECT_TRUE(sameBits(ownFilm, render("--spp 1")));

    GlimCall other;
    other.folder = folder.path();
    other.arguments = {"merge", "cornell_spheres-001.exr", "cornell_spheres-002.exr", "-o", "merged.exr"};
    const std::string shaders = "\"shaders=" + findSetting(redSettings, "shaders") + "\"";
    expectRefused(runForMessages(other), 1, MessageId::Mismatch, {.file = "cornell_spheres-002.exr", .place = "setting", .value = shaders});
    other.arguments = {"render", scene, "-o", "cornell_spheres-002.exr", "--resume", "--spp", "2", "--size", "96x72", "--caustics", "off"};
    expectRefused(runForMessages(other), 1, MessageId::Mismatch, {.file = "cornell_spheres-002.exr", .place = "setting", .value = shaders});
}

// The window's own kernels too, of which films know nothing.
TEST_F(PreviewShadersTest, TheColoursOfTheWindow)
{
    Pixels own;
    play({writes(1,
                 [&](const Film&) {
                     own = picture(1);
                     awaitWindow(own);
                 }),
          {[&] { replace("lib/display.glsl", "encodeSrgb(light)", "encodeSrgb(light.bgr)"); }, kTaken, [] {}},
          writes(2, [&](const Film&) {
              EXPECT_EQ(picture(2), own) << "made by the host";
              std::ranges::for_each(own, [](auto& pixel) { std::swap(pixel[0], pixel[2]); });
              awaitWindow(own);
          })});
}

// A change while another layer shows, whose picture is one of its own.
TEST_F(PreviewShadersTest, EveryLayer)
{
    play({writes(
              1, [&](const Film&) { awaitWindow(picture(1)); }, "v v v v v "),
          {[&] { replace(kAccumulate, kAdd, kAddRed); }, kTaken, [] {}},
          writes(
              2, [&](const Film&) { EXPECT_EQ(picture(2), onlyRed(picture(2))) << "shaded again"; }, "v ")});
    EXPECT_TRUE(sameBits(film(1), render("--spp 1 --view bvh-steps")));
    EXPECT_EQ(picture(1), rendered());
    EXPECT_EQ(findSetting(film(2).identity.settings, "view"), "");
    EXPECT_NE(findSetting(film(2).identity.settings, "shaders"), "");
}

// The first picture is by glim's own kernels until those of the folder are there.
TEST_F(PreviewShadersTest, WhatIsInTheFolderAtFirst)
{
    replace(kAccumulate, kAdd, kAddRed);
    replace("kernels/trace_shadow.comp", "void main()", "void main(");
    play({{[] {}, "glim: shaders/kernels/trace_shadow.comp:19: error: ", [] {}},
          writes(1, [&](const Film&) { EXPECT_NE(picture(1), onlyRed(picture(1))); }),
          {[&] { replace("kernels/trace_shadow.comp", "void main(", "void main()"); }, kTaken, [] {}},
          writes(2, [&](const Film&) { awaitWindow(onlyRed(picture(1))); })});
}

TEST_F(PreviewShadersTest, WhatCannotBeCompiledIsRefusedBeforeAWindowOpens)
{
    GlimCall session = call("", {"--shaders", "nowhere"});
    session.environment["DISPLAY"] = "";
    expectRefused(runForMessages(session), 2, MessageId::Empty, {.place = "--shaders", .value = "nowhere"});
    session.arguments.back() = "shaders";
    session.environment["PATH"] = folder.path();
    expectRefused(runForMessages(session), 2, MessageId::ProgramMissing, {.place = "--shaders", .expected = "glslangValidator"});
}

}  // namespace
}  // namespace glim::test
