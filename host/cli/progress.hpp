// Progress of a render, on stderr.
#pragma once

#include "host/cli/command.hpp"
#include "host/render/renderer.hpp"

#include <optional>

namespace glim {

enum class ProgressStyle { Auto, Bar, Json, None };

// --progress, into `style`.
void addProgress(const Command& command, ProgressStyle& style);

class ProgressPrinter {
public:
    // Auto: a bar on a terminal, nothing elsewhere. `timeLimit`: seconds, if time ends the render and not samples.
    ProgressPrinter(ProgressStyle style, std::optional<double> timeLimit, std::uint64_t pixels);

    // Prints at most ten times a second.
    void print(const RenderProgress& progress);
    // Removes the bar.
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
