#include "host/cli/progress.hpp"

#include "host/cli/parse.hpp"
#include "host/json.hpp"

#include <unistd.h>
#include <algorithm>
#include <cstdio>
#include <optional>

namespace glim {
namespace {

constexpr int kBarWidth = 30;
constexpr double kInterval = 0.1;  // seconds

double rate(const RenderProgress& progress)
{
    return progress.seconds > 0.0 ? static_cast<double>(progress.samples - progress.resumedSamples) / progress.seconds : 0.0;
}

}  // namespace

void addProgress(const Command& command, ProgressStyle& style)
{
    addChoice(command, "--progress", "STYLE", "Progress on stderr: bar, json (a line per step) or none [bar on a terminal]",
              {"bar", "json", "none"}, [&style](std::size_t i) {
                  constexpr ProgressStyle kStyles[] = {ProgressStyle::Bar, ProgressStyle::Json, ProgressStyle::None};
                  style = kStyles[i];
              });
}

ProgressPrinter::ProgressPrinter(ProgressStyle style, std::optional<double> timeLimit, std::uint64_t pixels, const SequencePlace& place)
    : style_(style),
      timeLimit_(timeLimit),
      pixels_(pixels),
      place_(place)
{
    if (style == ProgressStyle::Auto) {
        style_ = isatty(STDERR_FILENO) != 0 ? ProgressStyle::Bar : ProgressStyle::None;
    }
}

void ProgressPrinter::print(const RenderProgress& progress, const std::optional<WrittenCheckpoint>& checkpoint)
{
    const bool complete = progress.samples == progress.totalSamples;
    if (style_ == ProgressStyle::None || (progress.seconds - last_ < kInterval && !complete)) {
        return;
    }
    last_ = progress.seconds;
    double share = static_cast<double>(progress.samples) / static_cast<double>(progress.totalSamples);
    if (timeLimit_) {
        share = std::clamp(progress.seconds / *timeLimit_, share, 1.0);
    }
    const double resumed = static_cast<double>(progress.resumedSamples) / static_cast<double>(progress.totalSamples);
    const double remaining = share > resumed ? progress.seconds * (1.0 - share) / (share - resumed) : 0.0;
    const double perPicture = place_.rendered > 0 ? place_.seconds / static_cast<double>(place_.rendered) : progress.seconds + remaining;
    const double all = remaining + perPicture * static_cast<double>(place_.count - place_.index - 1);
    if (style_ == ProgressStyle::Bar) {
        printBar(progress, share, all);
    } else {
        printJson(progress, share, remaining, all, checkpoint);
    }
}

void ProgressPrinter::printBar(const RenderProgress& progress, double share, double all) const
{
    const std::string picture =
        place_.count > 1 ? "picture " + std::to_string(place_.index + 1) + " of " + std::to_string(place_.count) + " " : "";
    const int filled = static_cast<int>(share * kBarWidth);
    std::fprintf(stderr, "\r\033[K%s[%s%s] %3.0f %%  %.3g samples/pixel  %.3g Msamples/s  ETA %.0f s", picture.c_str(),
                 std::string(static_cast<std::size_t>(filled), '#').c_str(),
                 std::string(static_cast<std::size_t>(kBarWidth - filled), '.').c_str(), 100.0 * share,
                 static_cast<double>(progress.samples) / static_cast<double>(pixels_), 1e-6 * rate(progress), all);
}

void ProgressPrinter::printJson(const RenderProgress& progress, double share, double remaining, double all,
                                const std::optional<WrittenCheckpoint>& checkpoint) const
{
    Json line = {{"picture", place_.index + 1},
                 {"pictures", place_.count},
                 {"done", share},
                 {"samples", progress.samples},
                 {"totalSamples", progress.totalSamples},
                 {"seconds", progress.seconds},
                 {"samplesPerSecond", rate(progress)},
                 {"etaSeconds", remaining},
                 {"allEtaSeconds", all}};
    if (checkpoint) {
        line.set("checkpoint", Json{{"samplesPerPixel", checkpoint->samplesPerPixel}, {"secondsAgo", checkpoint->secondsAgo}});
    }
    std::fprintf(stderr, "%s\n", line.dump().c_str());
}

void ProgressPrinter::finish()
{
    if (style_ == ProgressStyle::Bar && last_ >= 0.0) {
        std::fprintf(stderr, "\r\033[K");
    }
}

}  // namespace glim
