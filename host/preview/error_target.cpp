#include "host/preview/error_target.hpp"

#include "host/image/png.hpp"
#include "host/text.hpp"
#include "shaders/shared/display_colors.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

constexpr double kLeastGrowth = 1.05;
constexpr double kLowestTarget = -6.0, kHighestTarget = 0.0;  // decimal logarithms
constexpr int kSteps = 40;                                    // of the scale's colours; even, so that two of them meet at the target

}  // namespace

double growthToNext(const ErrorPoint& last, double target)
{
    const double times = last.relMse / target;
    return times > 1.0 ? std::clamp(times, kLeastGrowth, kUsualGrowth) : kUsualGrowth;
}

std::string describeTarget(double target, const ErrorPoint& last, std::uint64_t samples, double samplesPerSecond, bool isDone)
{
    const std::string name = format("target %.3g", target);
    if (!last.isWhole) {
        return name + ": some pixels have too few samples";
    }
    if (last.relMse <= target) {
        return name + ": reached";
    }
    if (isDone) {
        return name + ": not reached";
    }
    if (samplesPerSecond <= 0.0) {
        return name + ": ETA unknown";
    }
    const double missing = static_cast<double>(last.samples) * last.relMse / target - static_cast<double>(samples);
    return format("about %.0f s to the ", std::max(0.0, missing) / samplesPerSecond) + name;
}

// Evenly in the target's logarithm, to two digits.
double targetSlider(double target)
{
    double exponent = std::log10(target);
    const std::string shown = format("relMSE %.2g", target);
    const bool moved = ImGui::SliderScalar("target", ImGuiDataType_Double, &exponent, &kLowestTarget, &kHighestTarget, shown.c_str(),
                                           ImGuiSliderFlags_NoInput);
    return moved ? std::stod(format("%.1e", std::pow(10.0, exponent))) : target;
}

void showErrorScale(double target)
{
    const float height = ImGui::GetFontSize(), width = ImGui::CalcItemWidth();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImGui::Dummy({width, 2.0F * height});
    for (int i = 0; i < kSteps; ++i) {
        const double place = (2.0 * i + 1.0) / kSteps - 1.0;
        const Rgb8 color = roundToBytes(errorColor(std::pow(kErrorSpan, place), 1.0));
        const float left = corner.x + width * static_cast<float>(i) / kSteps, right = corner.x + width * static_cast<float>(i + 1) / kSteps;
        list.AddRectFilled({left, corner.y}, {right, corner.y + height}, IM_COL32(color[0], color[1], color[2], 255));
    }
    for (int i = 0; i < 3; ++i) {  // the least, the target's and the largest
        const std::string error = format("%.2g %%", 100.0 * std::sqrt(target * std::pow(kErrorSpan, i - 1)));
        const float left = corner.x + 0.5F * static_cast<float>(i) * (width - ImGui::CalcTextSize(error.c_str()).x);
        list.AddText({left, corner.y + height}, ImGui::GetColorU32(ImGuiCol_Text), error.c_str());
    }
    ImGui::TextUnformatted("standard error; grey: unknown");
}

}  // namespace glim
