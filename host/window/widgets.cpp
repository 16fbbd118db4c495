#include "host/window/widgets.hpp"

#include <algorithm>
#include <utility>

namespace glim {
namespace {

constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
constexpr float kOpacity = 0.8F;
constexpr float kExposureRange = 10.0F;               // stops to either side of 0
constexpr float kWidth = 17.0F;                       // of the controls, in heights of the font
constexpr float kClosedWidth = 8.0F;                  // of a side panel's title, the same
constexpr float kMessageWidth = 40.0F;                // the same
constexpr ImU32 kBeside = IM_COL32(51, 51, 51, 255);  // as `glim view` has it
constexpr float kSmallest = 0.25F;                    // of the help's text, relative to the font

// How much smaller the table and the title must be for the panel to fit into the window; its margins stay.
float helpScale(std::span<const HelpLine> lines, float below)
{
    const ImGuiStyle& style = ImGui::GetStyle();
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    float keys = 0.0F, meanings = 0.0F;
    for (const auto& [key, meaning] : lines) {
        keys = std::max(keys, ImGui::CalcTextSize(key).x);
        meanings = std::max(meanings, ImGui::CalcTextSize(meaning).x);
    }
    const auto rows = static_cast<float>(lines.size());
    const float wide = (window.x - 2.0F * style.WindowPadding.x) / (keys + meanings + 4.0F * style.CellPadding.x);
    const float margins = 2.0F * (style.WindowPadding.y + style.FramePadding.y);
    const float high = (window.y - below - margins) / ((rows + 1.0F) * ImGui::GetFontSize() + 2.0F * rows * style.CellPadding.y);
    return std::clamp(std::min(wide, high), kSmallest, 1.0F);
}

bool beginControls(const char* title)
{
    ImGui::SetNextWindowBgAlpha(kOpacity);
    const bool shows = ImGui::Begin(title, nullptr, kFlags);
    ImGui::PushItemWidth(kWidth * ImGui::GetFontSize() - ImGui::CalcTextSize("exposure").x);
    return shows;
}

}  // namespace

bool beginPanel(const char* title)
{
    ImGui::SetNextWindowPos({0.0F, 0.0F}, ImGuiCond_FirstUseEver);
    return beginControls(title);
}

bool beginSidePanel(const char* title)
{
    ImGui::SetNextWindowPos(ImGui::GetIO().DisplaySize, ImGuiCond_Always, {1.0F, 1.0F});
    ImGui::SetNextWindowCollapsed(true, ImGuiCond_FirstUseEver);
    const bool shows = beginControls(title);
    if (!shows) {
        ImGui::SetWindowSize({kClosedWidth * ImGui::GetFontSize(), ImGui::GetWindowHeight()});
    }
    return shows;
}

void endPanel()
{
    ImGui::PopItemWidth();
    ImGui::End();
}

void fillBeside(const Rectangle& shown)
{
    const ImVec2 end = ImGui::GetIO().DisplaySize;
    const ImVec2 low(static_cast<float>(shown.low.x), static_cast<float>(shown.low.y));
    const ImVec2 high(static_cast<float>(shown.high.x), static_cast<float>(shown.high.y));
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (const auto& [from, to] :
         {std::pair(ImVec2(0.0F, 0.0F), ImVec2(end.x, low.y)), std::pair(ImVec2(0.0F, high.y), end),
          std::pair(ImVec2(0.0F, low.y), ImVec2(low.x, high.y)), std::pair(ImVec2(high.x, low.y), ImVec2(end.x, high.y))}) {
        if (from.x < to.x && from.y < to.y) {
            list.AddRectFilled(from, to, kBeside);
        }
    }
}

bool beginInset(const char* title)
{
    ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x, 0.0F}, ImGuiCond_Always, {1.0F, 0.0F});
    ImGui::SetNextWindowBgAlpha(kOpacity);
    return ImGui::Begin(title, nullptr, kFlags | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoInputs);
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

void showHelp(std::span<const HelpLine> lines, float below)
{
    const float scale = helpScale(lines, below);
    ImGui::SetNextWindowPos({0.0F, 0.0F}, ImGuiCond_Always);
    ImGui::SetNextWindowBgAlpha(kOpacity);
    const bool shows = ImGui::Begin("keys and mouse", nullptr, kFlags | ImGuiWindowFlags_NoCollapse);
    ImGui::SetWindowFontScale(scale);
    const ImVec2 padding = ImGui::GetStyle().CellPadding;
    ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {scale * padding.x, scale * padding.y});
    if (shows && ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const auto& [key, meaning] : lines) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(key);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(meaning);
        }
        ImGui::EndTable();
    }
    ImGui::PopStyleVar();
    ImGui::End();
}

float showMessages(const std::vector<std::string>& lines)
{
    if (lines.empty()) {
        return 0.0F;
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
    const float height = ImGui::GetWindowHeight();
    ImGui::End();
    return height;
}

}  // namespace glim
