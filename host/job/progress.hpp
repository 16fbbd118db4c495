// Progress of a render, on stderr.
#pragma once

#include "host/job/option_table.hpp"
#include "host/render/renderer.hpp"

#include <optional>
#include <string>

namespace glim {

enum class ProgressStyle { Auto, Bar, Json, None };

// --progress, into `style`.
void addProgress(OptionTable& table, ProgressStyle& style);

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

// How far a picture is.
struct ProgressEstimate {
    double share = 0.0;               // done, in [0, 1]
    std::optional<double> remaining;  // seconds to its end, not negative; unknown at the beginning and past an end that was foretold
};

// `timeLimit`: seconds, if time ends the render and not samples.
ProgressEstimate estimateProgress(const RenderProgress& progress, std::optional<double> timeLimit);

// What a terminal of so many columns shows of a bar: it must not reach the last one, or the line might wrap. 0: unknown.
std::string fitBar(const std::string& bar, unsigned columns);

class ProgressPrinter {
public:
    // Auto: a bar on a terminal, nothing elsewhere.
    ProgressPrinter(ProgressStyle style, std::optional<double> timeLimit, std::uint64_t pixels, const SequencePlace& place = {});

    // Prints at most ten times a second, and not while stderr takes nothing (a terminal that is stopped, a pipe that is full). Never
    // throws.
    void print(const RenderProgress& progress, const std::optional<WrittenCheckpoint>& checkpoint = {});
    // The same, of what comes before the picture's samples: a guide is learned. `done` is in [0, 1].
    void printLearning(double done, double seconds);
    // Removes the bar.
    void finish();

private:
    void write(const RenderProgress& progress, const std::optional<WrittenCheckpoint>& checkpoint) const;
    // Seconds to the end of the last picture.
    std::optional<double> estimateAll(const RenderProgress& progress, const ProgressEstimate& estimate) const;
    std::string barOf(double share) const;
    std::string formatBar(const RenderProgress& progress, const ProgressEstimate& estimate) const;
    std::string toJson(const RenderProgress& progress, const ProgressEstimate& estimate,
                       const std::optional<WrittenCheckpoint>& checkpoint) const;

    ProgressStyle style_;
    std::optional<double> timeLimit_;
    std::uint64_t pixels_;
    SequencePlace place_;
    double last_ = -1.0;
    std::uint64_t lastSamples_ = 0;
};

}  // namespace glim
