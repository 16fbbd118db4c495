#include "tests/support/preview_fixture.hpp"

#include "host/image/png.hpp"
#include "host/render/aov.hpp"
#include "host/render/composite.hpp"
#include "host/render/film_file.hpp"
#include "shaders/shared/display_colors.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace glim::test {
namespace {

void expectSilence(const GlimRun& done) { EXPECT_EQ(done.err.find("validation"), std::string::npos) << done.err; }

double computeShareOfLight(const Pixels& window)
{
    const auto lit = std::count_if(window.begin(), window.end(), [](const auto& pixel) { return pixel != std::array{0, 0, 0}; });
    return static_cast<double>(lit) / static_cast<double>(window.size());
}

// Calls `look` when the key P has written a picture, then ends the session.
void whenWritten(GlimCall session, const std::function<void()>& look)
{
    session.signalWhen = [&look](const std::string& err) {
        if (err.find("wrote") == std::string::npos) {
            return false;
        }
        look();
        return true;
    };
    session.signal = SIGTERM;
    const GlimRun done = runGlim(session);
    EXPECT_EQ(done.signal, SIGTERM) << done.err;
    expectSilence(done);
}

}  // namespace

GlimCall PreviewTest::call(const std::string& script, const std::vector<std::string>& more) const
{
    std::ofstream(folder / "script") << (panels ? "" : "0 key H\n0 key H\n") << script;
    GlimCall made;
    made.arguments = {"preview", scene, "--script", "script", "--size", size()};
    if (ownWindow) {
        made.arguments.insert(made.arguments.end(), {"--window", std::to_string(ownWindow->x) + "x" + std::to_string(ownWindow->y)});
    }
    made.arguments.insert(made.arguments.end(), more.begin(), more.end());
    made.environment.insert({{"DISPLAY", screen.name()}, {"GLIM_VALIDATION", "1"}});
    made.folder = folder.path();
    return made;
}

GlimRun PreviewTest::run(const std::string& script, const std::vector<std::string>& more) const
{
    GlimRun done = runGlim(call(script, more));
    EXPECT_EQ(done.exitCode, 0) << "signal " << done.signal << "; " << done.err;
    expectSilence(done);
    return done;
}

Pixels PreviewTest::windowAtWriting(const VirtualScreen& shown, const std::string& script, const std::vector<std::string>& more) const
{
    Pixels seen(std::size_t{windowSize().x} * windowSize().y);  // black if the session fails
    GlimCall session = call(script, more);
    session.environment["DISPLAY"] = shown.name();
    whenWritten(session, [&] { seen = windowOf(shown.calmPixels()); });
    return seen;
}

PreviewTest::Watched PreviewTest::watch(std::size_t pictures, const std::string& script, const std::vector<std::string>& more) const
{
    Watched seen;
    whenWritten(call(script, more), [&] {
        const auto start = std::chrono::steady_clock::now();
        const auto isWithin = [start](int seconds) { return std::chrono::steady_clock::now() < start + std::chrono::seconds(seconds); };
        while (isWithin(3) || (seen.pictures.size() < pictures && isWithin(60))) {
            const Pixels now = windowOf(screen.pixels());
            seen.minLight = std::min(seen.minLight, computeShareOfLight(now));
            seen.pictures.insert(now);
        }
    });
    return seen;
}

Film PreviewTest::render(const std::string& options) const
{
    GlimCall made;
    made.arguments = {"render", scene, "-o", "r.exr", "--png", "r.png"};
    std::istringstream words(options);
    for (std::string word; words >> word;) {
        made.arguments.push_back(word);
    }
    if (options.find("--view") == std::string::npos) {
        made.arguments.insert(made.arguments.end(), {"--caustics", "off"});  // as in the window
    }
    if (options.find("--size") == std::string::npos) {
        made.arguments.insert(made.arguments.end(), {"--size", size()});
    }
    made.folder = folder.path();
    const GlimRun done = runGlim(made);
    EXPECT_EQ(done.exitCode, 0) << options << done.err;
    return readFilm(folder / "r.exr");
}

std::string PreviewTest::numbered(int number) const
{
    return folder / (std::filesystem::path(scene).stem().string() + (number < 10 ? "-00" : "-0") + std::to_string(number)).c_str();
}

Film PreviewTest::film(int number) const { return readFilm(numbered(number) + ".exr"); }

Pixels PreviewTest::picture(int number) const { return decodePng(numbered(number) + ".png"); }

void PreviewTest::removePictures() const
{
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        std::filesystem::remove(entry.path());
    }
}

Pixels cornerOf(const Pixels& shown, std::size_t width, std::size_t height)
{
    Pixels corner;
    for (std::size_t y = 0; y < height; ++y) {
        const auto row = shown.begin() + static_cast<std::ptrdiff_t>(y * VirtualScreen::kWidth);
        corner.insert(corner.end(), row, row + static_cast<std::ptrdiff_t>(width));
    }
    return corner;
}

Pixels overCheckerboard(const Film& film)
{
    Pixels expected;
    for (const PixelMoments& pixel : pictureOf(film)) {
        const auto i = static_cast<std::uint32_t>(expected.size());
        const Rgba8 color = displaySurfaces(pixel, Aov::Radiance, {}, {});
        const Rgb8 shown = roundToBytes(overCheckers({color[0], color[1], color[2]}, pixel.alpha, i % film.width, i / film.width));
        expected.push_back({shown[0], shown[1], shown[2]});
    }
    return expected;
}

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

std::vector<std::string> printedOptions(const GlimRun& session)
{
    std::istringstream out(session.out);
    std::vector<std::string> lines;
    for (std::string line; std::getline(out, line);) {
        if (line.starts_with("--camera")) {
            lines.push_back(line);
        }
    }
    return lines;
}

std::string firstLine(const std::string& out) { return out.substr(0, out.find('\n')); }

}  // namespace glim::test
