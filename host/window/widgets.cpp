#include "host/window/widgets.hpp"

#include <algorithm>

namespace glim {
namespace {

constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
constexpr float kOpacity = 0.8F;
constexpr float kExposureRange = 10.0F;  // stops to either side of 0
constexpr float kWidth = 17.0F;          // of the controls, in heights of the font
constexpr float kMessageWidth = 40.0F;   // the same

}  // namespace

bool beginPanel(const char* title)
{
    ImGui::SetNextWindowPos({0.0F, 0.0F}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowBgAlpha(kOpacity);
    const bool shows = ImGui::Begin(title, nullptr, kFlags);
    ImGui::PushItemWidth(kWidth * ImGui::GetFontSize() - ImGui::CalcTextSize("exposure").x);
    return shows;
}

void endPanel()
{
    ImGui::PopItemWidth();
    ImGui::End();
}

double exposureSlider(double stops)
{
    auto chosen = static_cast<float>(stops);
    const bool moved = ImGui::SliderFloat("exposure", &chosen, -kExposureRange, kExposureRange, "%+.1f EV", ImGuiSliderFlags_NoInput);
    return moved ? static_cast<double>(chosen) : stops;
}

Tone toneCombo(Tone chosen)
{
    return choose("tone", {Tone::None, Tone::Neutral, Tone::Agx}, chosen, [](Tone tone) { return getName(tone); });
}

void showHelp(std::span<const HelpLine> lines)
{
    const float left = kWidth * ImGui::GetFontSize() + 8.0F * ImGui::GetStyle().WindowPadding.x;
    ImGui::SetNextWindowPos({left, 0.0F}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowBgAlpha(kOpacity);
    if (ImGui::Begin("keys and mouse", nullptr, kFlags) && ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const auto& [key, meaning] : lines) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(key);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(meaning);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

void showMessages(const std::vector<std::string>& lines)
{
    if (lines.empty()) {
        return;
    }
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.0F, size.y}, ImGuiCond_Always, {0.0F, 1.0F});
    ImGui::SetNextWindowBgAlpha(kOpacity);
    if (ImGui::Begin("messages", nullptr, kFlags | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoInputs)) {
        ImGui::PushTextWrapPos(std::min(size.x - 2.0F * ImGui::GetStyle().WindowPadding.x, kMessageWidth * ImGui::GetFontSize()));
        for (const std::string& line : lines) {
            ImGui::TextUnformatted(line.c_str());
        }
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
}

}  // namespace glim
