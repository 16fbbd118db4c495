#include "host/job/progress.hpp"

#include "host/job/parse.hpp"
#include "host/json.hpp"
#include "host/message.hpp"
#include "host/text.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>

namespace glim {
namespace {

constexpr std::size_t kBarWidth = 30;
constexpr double kInterval = 0.1;  // seconds

double rate(const RenderProgress& progress)
{
    return progress.seconds > 0.0 ? static_cast<double>(progress.samples - progress.resumedSamples) / progress.seconds : 0.0;
}

// Of the terminal as it is now; 0: unknown.
unsigned columnsOf(int file)
{
    winsize size{};
    return ioctl(file, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

}  // namespace

void addProgress(OptionTable& table, ProgressStyle& style)
{
    addChoice(table, "--progress", "STYLE", "Progress on stderr: bar, json (a line per step) or none [bar on a terminal]",
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

ProgressEstimate estimateProgress(const RenderProgress& progress, std::optional<double> timeLimit)
{
    const auto shareOf = [&](std::uint64_t samples) {
        return progress.totalSamples > 0 ? static_cast<double>(samples) / static_cast<double>(progress.totalSamples) : 0.0;
    };
    double share = shareOf(progress.samples);
    if (timeLimit && *timeLimit > 0.0) {
        share = std::max(share, progress.seconds / *timeLimit);
    }
    ProgressEstimate estimate{std::min(share, 1.0), std::nullopt};
    const double begun = shareOf(progress.resumedSamples);
    if (share > begun && share <= 1.0) {
        estimate.remaining = progress.seconds * (1.0 - share) / (share - begun);
    }
    return estimate;
}

std::string fitBar(const std::string& bar, unsigned columns) { return columns == 0 ? bar : bar.substr(0, columns - 1); }

void ProgressPrinter::print(const RenderProgress& progress, const std::optional<WrittenCheckpoint>& checkpoint)
{
    const bool completed = progress.samples == progress.totalSamples && progress.samples != lastSamples_;
    if (style_ == ProgressStyle::None || (progress.seconds - last_ < kInterval && !completed) || !takesMore(STDERR_FILENO)) {
        return;
    }
    last_ = progress.seconds;
    lastSamples_ = progress.samples;
    try {
        write(progress, checkpoint);
    } catch (const std::exception&) {
        // No memory: a later line may succeed.
    }
}

void ProgressPrinter::printLearning(double done, double seconds)
{
    if (style_ == ProgressStyle::None || seconds - last_ < kInterval || !takesMore(STDERR_FILENO)) {
        return;
    }
    last_ = seconds;
    try {
        const std::string text = style_ == ProgressStyle::Bar
                                     ? "\r\033[K" + fitBar(barOf(done) + " learning where light comes from", columnsOf(STDERR_FILENO))
                                     : Json{{"picture", place_.index + 1}, {"pictures", place_.count}, {"learned", done}}.dump() + '\n';
        std::fwrite(text.data(), 1, text.size(), stderr);
    } catch (const std::exception&) {
        // No memory: a later line may succeed.
    }
}

void ProgressPrinter::write(const RenderProgress& progress, const std::optional<WrittenCheckpoint>& checkpoint) const
{
    const ProgressEstimate estimate = estimateProgress(progress, timeLimit_);
    const std::string text = style_ == ProgressStyle::Bar ? "\r\033[K" + fitBar(formatBar(progress, estimate), columnsOf(STDERR_FILENO))
                                                          : toJson(progress, estimate, checkpoint) + '\n';
    std::fwrite(text.data(), 1, text.size(), stderr);
}

std::optional<double> ProgressPrinter::estimateAll(const RenderProgress& progress, const ProgressEstimate& estimate) const
{
    if (!estimate.remaining) {
        return std::nullopt;
    }
    const double perPicture =
        place_.rendered > 0 ? place_.seconds / static_cast<double>(place_.rendered) : progress.seconds + *estimate.remaining;
    return *estimate.remaining + perPicture * static_cast<double>(place_.count - place_.index - 1);
}

std::string ProgressPrinter::barOf(double share) const
{
    const std::string picture =
        place_.count > 1 ? "picture " + std::to_string(place_.index + 1) + " of " + std::to_string(place_.count) + " " : "";
    const auto filled = static_cast<std::size_t>(share * kBarWidth);
    return picture + '[' + std::string(filled, '#') + std::string(kBarWidth - filled, '.') + format("] %3.0f %% ", 100.0 * share);
}

std::string ProgressPrinter::formatBar(const RenderProgress& progress, const ProgressEstimate& estimate) const
{
    const auto all = estimateAll(progress, estimate);
    return barOf(estimate.share) +
           format(" %.3g samples/pixel  %.3g Msamples/s  ETA ", static_cast<double>(progress.samples) / static_cast<double>(pixels_),
                  1e-6 * rate(progress)) +
           (all ? format("%.0f s", *all) : "unknown");
}

std::string ProgressPrinter::toJson(const RenderProgress& progress, const ProgressEstimate& estimate,
                                    const std::optional<WrittenCheckpoint>& checkpoint) const
{
    Json line = {{"picture", place_.index + 1},
                 {"pictures", place_.count},
                 {"done", estimate.share},
                 {"samples", progress.samples},
                 {"totalSamples", progress.totalSamples},
                 {"seconds", progress.seconds},
                 {"samplesPerSecond", rate(progress)},
                 {"etaSeconds", estimate.remaining},
                 {"allEtaSeconds", estimateAll(progress, estimate)}};
    if (checkpoint) {
        line.set("checkpoint", Json{{"samplesPerPixel", checkpoint->samplesPerPixel}, {"secondsAgo", checkpoint->secondsAgo}});
    }
    return line.dump();
}

void ProgressPrinter::finish()
{
    if (style_ == ProgressStyle::Bar && last_ >= 0.0 && takesMore(STDERR_FILENO)) {
        std::fputs("\r\033[K", stderr);
    }
}

}  // namespace glim
