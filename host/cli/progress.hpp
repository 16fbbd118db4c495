// How far a render is, on stderr.
#pragma once

#include "host/cli/render_options.hpp"
#include "host/render/renderer.hpp"

#include <optional>

namespace glim {

class ProgressPrinter {
public:
    // Auto: a bar on a terminal, nothing elsewhere. `timeLimit` seconds, if time and not samples ends the render.
    ProgressPrinter(ProgressStyle style, std::optional<double> timeLimit, std::uint64_t pixels);

    // Prints at most ten times a second.
    void print(const RenderProgress& progress);
    // Takes the bar away.
    void finish();

private:
    void printBar(const RenderProgress& progress, double share, double remaining) const;
    void printJson(const RenderProgress& progress, double share, double remaining) const;

    ProgressStyle style_;
    std::optional<double> timeLimit_;
    std::uint64_t pixels_;
    double last_ = -1.0;
};

}  // namespace glim
