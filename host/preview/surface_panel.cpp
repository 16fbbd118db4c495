#include "host/preview/surface_panel.hpp"

#include "host/text.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

constexpr float kMostEmission = 1000.0F;
constexpr float kNameWidth = 17.0F;  // as wide as the other controls, in heights of the font

void changeFactors(std::size_t begin, std::size_t end, SurfaceChoices& choices)
{
    for (std::size_t i = begin; i < end; ++i) {
        const MaterialFactor& factor = kMaterialFactors[i];
        ImGui::SliderFloat(factor.name, &choices.factors[i], factor.least, factor.most, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    }
}

}  // namespace

SurfaceChoices changeSurface(const SurfaceFigures& figures, SurfaceChoices choices)
{
    if (!figures.name.empty()) {
        ImGui::PushTextWrapPos(kNameWidth * ImGui::GetFontSize());
        ImGui::TextUnformatted(figures.name.c_str());
        ImGui::PopTextWrapPos();
    }
    if (figures.hasMaterial) {
        ImGui::ColorEdit3("base colour", &choices.baseColor.r, ImGuiColorEditFlags_Float);
        changeFactors(0, kUsualFactors, choices);
    }
    if (figures.hasNode) {
        const float step = 0.01F * std::max(1.0F, std::abs(choices.translation.x));
        ImGui::DragFloat3("translation, m", &choices.translation.x, step, 0.0F, 0.0F, "%.3g");
        choices.hides = ImGui::Button("hide");
        ImGui::SameLine();
        choices.isolates = ImGui::Button("isolate");
    }
    if (figures.hidden > 0) {
        if (figures.hasNode) {
            ImGui::SameLine();
        }
        choices.showsAll = ImGui::Button(("show all (" + std::to_string(figures.hidden) + " hidden)###show all").c_str());
    }
    if (figures.hasMaterial && ImGui::TreeNode("more of its material")) {
        changeFactors(kUsualFactors, kMaterialFactors.size(), choices);
        ImGui::SliderFloat("alpha", &choices.baseColor.a, 0.0F, 1.0F, "%.2f", ImGuiSliderFlags_AlwaysClamp);
        ImGui::ColorEdit3("emission", &choices.emission.r, ImGuiColorEditFlags_Float);
        ImGui::SliderFloat("emission x", &choices.emissionStrength, 1.0F, kMostEmission, "%.3g",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
        ImGui::TreePop();
    }
    return choices;
}

}  // namespace glim
