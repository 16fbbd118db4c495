// The text over the picture: statistics, help and messages.
#include "host/preview/session.hpp"

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <iterator>

namespace glim {
namespace {

constexpr double kNoticeSeconds = 6.0;

constexpr const char* kHelp[] = {
    "",
    "drag\torbit",
    "shift-drag, middle-drag\tpan",
    "wheel\tnearer, farther",
    "W A S D Q E\tfly: forward, left, back, right, down, up",
    "F\tframe the scene",
    "R\treset to the file's camera",
    "1-9\tthe file's cameras",
    "+ -\texposure",
    "V\tviews: shaded, normal, depth, albedo, samples, BVH steps",
    "click\tprint what is there",
    "Space\tpause",
    "P\twrite PNG and EXR",
    "C\tprint the camera",
    "H\tshow statistics, help, nothing",
    "Esc\tquit",
};

std::string nameOf(Aov aov)
{
    constexpr const char* kNames[] = {"shaded", "normal", "depth", "albedo", "BVH steps", "samples"};
    return kNames[static_cast<int>(aov)];
}

__attribute__((format(printf, 1, 2))) std::string format(const char* pattern, ...)
{
    char text[200];
    va_list values;
    va_start(values, pattern);
    std::vsnprintf(text, sizeof text, pattern, values);
    va_end(values);
    return text;
}

}  // namespace

std::vector<std::string> Session::figures()
{
    Refiner& picture = refiner();
    std::vector<std::string> lines;
    const std::uint32_t samples = picture.renderer().sampleCount();
    const std::string state = paused_ ? ", paused" : picture.isDone() && picture.scale() == 1 ? ", done" : "";
    lines.push_back(format("%u sample%s in %.1f s, %.2f Msamples/s%s", samples, samples == 1 ? "" : "s", picture.seconds(),
                           picture.samplesPerSecond() * 1e-6, state.c_str()));
    if (relMse_ && picture.scale() == 1) {
        lines.push_back(format("estimated relMSE %.3g at %llu samples", *relMse_, static_cast<unsigned long long>(estimatedAt_)));
    }
    std::string view = nameOf(aov_);
    if (look_.exposure != 0.0) {
        view += format(", %+.1f EV", look_.exposure);
    }
    if (aov_ == Aov::Radiance && look_.tone != Tone::None) {
        view += std::string(", ") + glim::nameOf(look_.tone);
    }
    const std::string size = picture.scale() == 1 ? "full size" : "1/" + std::to_string(picture.scale()) + " size";
    lines.push_back(view + format(", %ux%u, ", display_.width(), display_.height()) + size);
    lines.push_back(device_.description().name);
    return lines;
}

std::vector<std::string> Session::overlay()
{
    std::vector<std::string> lines;
    if (overlayLevel_ == 0 && light_) {
        return lines;
    }
    if (light_) {
        lines = figures();
    }
    if (!title_.empty()) {
        lines.push_back(title_);
    }
    if (overlayLevel_ == 2) {
        lines.insert(lines.end(), std::begin(kHelp), std::end(kHelp));
    } else if (overlayLevel_ == 1 && light_) {
        lines.push_back("H: help");
    }
    if (!trouble_.empty()) {
        lines.push_back(trouble_);
    }
    const bool recent = std::chrono::duration<double>(Clock::now() - noticeTime_).count() < kNoticeSeconds;
    if (recent && !notice_.empty() && notice_ != trouble_) {
        lines.push_back(notice_);
    }
    return lines;
}

}  // namespace glim
