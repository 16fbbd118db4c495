// Scripted sessions of `glim preview` on a screen of the test's own.
#pragma once

#include "host/render/film.hpp"
#include "tests/support/decode_png.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/virtual_screen.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace glim::test {

using Pixels = std::vector<std::array<int, 3>>;

// The upper left part of a screen, where windows open.
Pixels cornerOf(const Pixels& shown, std::size_t width, std::size_t height);

class PreviewTest : public testing::Test {
protected:
    // `glim preview` of `scene` in a folder of its own, with the steps of `script`, one per line. It first hides the panels, unless
    // `panels`.
    GlimCall call(const std::string& script, const std::vector<std::string>& more = {}) const;
    // Expects no error and no message of the validation layers.
    GlimRun run(const std::string& script, const std::vector<std::string>& more = {}) const;
    // What is in the window on `shown`, once it rests, when the script has pressed P; ends the session then.
    Pixels windowAtWriting(const VirtualScreen& shown, const std::string& script, const std::vector<std::string>& more = {}) const;
    // Looks at the window again and again once the script has pressed P: for three seconds and until it has seen as many
    // `pictures`, but for no longer than a minute.
    struct Watched {
        std::set<Pixels> pictures;  // all that were seen
        double minLight = 1.0;      // the share of the window that was not black, at the least
    };
    Watched watch(std::size_t pictures, const std::string& script, const std::vector<std::string>& more = {}) const;
    // The part of the screen that is the window.
    Pixels windowOf(const Pixels& shown) const { return cornerOf(shown, windowSize().x, windowSize().y); }

    // What `glim render` makes of the same scene; `options` separated by blanks.
    Film render(const std::string& options) const;
    Pixels rendered() const { return decodePng(folder / "r.png"); }
    // The film and the picture that the N-th P of a session wrote.
    Film film(int number) const;
    Pixels picture(int number) const;
    void removePictures() const;

    ScratchFolder folder;
    VirtualScreen screen;
    std::string scene = sceneFile("cornell_spheres.gltf");
    std::uint32_t width = 96, height = 72;  // of the picture
    std::optional<glm::uvec2> ownWindow;    // absent: the picture's size
    bool panels = false;

private:
    glm::uvec2 windowSize() const { return ownWindow.value_or(glm::uvec2(width, height)); }
    std::string size() const { return std::to_string(width) + "x" + std::to_string(height); }
    std::string numbered(int number) const;
};

// A film's light as the window shows it where its picture is transparent.
Pixels overCheckerboard(const Film& film);

// How many pixels differ by more than one step of eight bits in a channel (rounding in float and in double may differ by one); -1
// if the sizes differ.
int countOthers(const Pixels& a, const Pixels& b);

// The lines of options that C printed.
std::vector<std::string> printedOptions(const GlimRun& session);
// The first line that a session printed: the camera's options, as C prints them.
std::string firstLine(const std::string& out);

}  // namespace glim::test
