#include "host/view/view_panel.hpp"

#include "host/window/widgets.hpp"

#include <imgui.h>

#include <numeric>

namespace glim {
namespace {

constexpr HelpLine kHelp[] = {
    {"drag", "move the picture"},
    {"wheel", "zoom"},
    {"F", "fit the window"},
    {"1", "actual size"},
    {"V", "next layer"},
    {"B", "A, B or A - B"},
    {"+ -", "exposure, or gain of A - B"},
    {"T", "next tone"},
    {"L", "print the lights, for glim merge"},
    {"click", "print the pixel's layers"},
    {"H", "controls, these keys, nothing"},
    {"F11", "full screen, or the window again"},
    {"Esc", "quit"},
};

// What the light is multiplied by: evenly in stops, and 0 at the left end.
double lightSlider(const std::string& group, double factor)
{
    constexpr float kMost = 16.0F, kLeast = 0.01F;
    auto chosen = static_cast<float>(factor);
    const bool moved = ImGui::SliderFloat(("light " + group).c_str(), &chosen, 0.0F, kMost, "x %.2f", ImGuiSliderFlags_Logarithmic);
    return moved ? (chosen < kLeast ? 0.0 : static_cast<double>(chosen)) : factor;
}

const char* getName(Side side)
{
    constexpr const char* kNames[] = {"A", "B", "A - B"};
    return kNames[static_cast<int>(side)];
}

}  // namespace

ViewChoices showViewPanel(const ViewFigures& figures, ViewChoices choices)
{
    if (beginPanel("glim view (H: help)###controls")) {
        std::vector<std::size_t> indices(figures.layers.size());
        std::iota(indices.begin(), indices.end(), std::size_t{0});
        choices.layer = choose("layer", indices, choices.layer, [&](std::size_t i) { return figures.layers[i].c_str(); });
        if (figures.sides.size() > 1) {
            choices.side = choose("film", figures.sides, choices.side, [](Side side) { return getName(side); });
        }
        ImGui::BeginDisabled(!figures.isExposed);
        choices.exposure = exposureSlider(choices.exposure);
        ImGui::EndDisabled();
        ImGui::BeginDisabled(!figures.isToned);
        choices.tone = toneCombo(choices.tone);
        ImGui::EndDisabled();
        for (std::size_t g = 0; g < figures.lights.size(); ++g) {
            choices.lights[g] = lightSlider(figures.lights[g], choices.lights[g]);
        }
        ImGui::Separator();
        for (const std::string& line : figures.lines) {
            ImGui::TextUnformatted(line.c_str());
        }
    }
    endPanel();
    return choices;
}

void showViewHelp(float below) { showHelp(kHelp, below); }

}  // namespace glim
