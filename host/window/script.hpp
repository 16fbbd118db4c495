// Scripted sessions, for tests and measurements.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glim {

struct ScriptStep {
    enum class Kind { Press, Release, Key, Drag, Scroll, Click, Resize, Scale, Iconify, Restore, Drop, Samples, Close };
    double delay = 0.0;  // seconds since the previous step
    Kind kind = Kind::Close;
    char key = 0;
    bool pan = false;  // a drag with the middle button
    glm::dvec2 from{0.0}, to{0.0};
    double notches = 0.0;
    glm::uvec2 size{0};
    float scale = 1.0F;          // of the display, as it changes with another display
    std::filesystem::path file;  // that is dropped
    std::uint64_t samples = 0;   // waits until every pixel has as many
};

// Each line is one step: its delay, then one of
//   key K | press K | release K      K: a letter, a digit, + or -, space, escape or F11
//   drag left|middle X,Y X,Y         pixels
//   scroll N | click X,Y | resize WxH | iconify | restore
//   scale N                          of the display, as if the window had come to another one
//   drop FILE                        relative to the script's folder; the rest of the line is its name
//   samples N                        waits until all pixels have N samples, or until sampling has ended
//   close
// Blank lines and comments, which begin with #, are skipped. Throws InputError with the file, the line and what was expected.
std::vector<ScriptStep> readScript(const std::filesystem::path& file);

}  // namespace glim
