// Progress of a render, on stderr.
#pragma once

#include "host/cli/command.hpp"
#include "host/render/renderer.hpp"

#include <optional>

namespace glim {

enum class ProgressStyle { Auto, Bar, Json, None };

// --progress, into `style`.
void addProgress(const Command& command, ProgressStyle& style);

// Which of several pictures is rendered, and how long those before it took.
struct SequencePlace {
    std::size_t index = 0, count = 1;
    std::size_t rendered = 0;
    double seconds = 0.0;  // of the rendered ones
};

// The last one that was written.
struct WrittenCheckpoint {
    double samplesPerPixel, secondsAgo;
};

class ProgressPrinter {
public:
    // Auto: a bar on a terminal, nothing elsewhere. `timeLimit`: seconds, if time ends the render and not samples.
    ProgressPrinter(ProgressStyle style, std::optional<double> timeLimit, std::uint64_t pixels, const SequencePlace& place = {});

    // Prints at most ten times a second.
    void print(const RenderProgress& progress, const std::optional<WrittenCheckpoint>& checkpoint = {});
    // Removes the bar.
    void finish();

private:
    // `remaining`: seconds to the end of this picture; `all`: to that of the last one.
    void printBar(const RenderProgress& progress, double share, double all) const;
    void printJson(const RenderProgress& progress, double share, double remaining, double all,
                   const std::optional<WrittenCheckpoint>& checkpoint) const;

    ProgressStyle style_;
    std::optional<double> timeLimit_;
    std::uint64_t pixels_;
    SequencePlace place_;
    double last_ = -1.0;
};

}  // namespace glim
