#include "host/preview/scene_panel.hpp"

#include "host/scene/make_floor.hpp"
#include "host/window/widgets.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

constexpr float kLeastStrength = 0.01F, kMostStrength = 100.0F;
constexpr float kLeastIrradiance = 0.01F, kMostIrradiance = 1000.0F;  // W/m^2
constexpr double kHalfTurn = 180.0, kZenith = 90.0;                   // degrees

using Choice = std::optional<EnvironmentChoice>;

std::string environmentName(const Choice& choice)
{
    if (!choice) {
        return "as in the file";
    }
    if (const auto* file = std::get_if<std::filesystem::path>(&*choice)) {
        return file->filename().string();
    }
    if (const auto* builtIn = std::get_if<BuiltInEnvironment>(&*choice)) {
        return *builtIn == BuiltInEnvironment::None ? "none" : "studio";
    }
    return "constant";
}

Choice environmentCombo(const std::vector<std::filesystem::path>& maps, Choice chosen)
{
    std::vector<Choice> all{std::nullopt, BuiltInEnvironment::Studio, BuiltInEnvironment::None, glm::vec3(1.0F)};
    all.insert(all.end(), maps.begin(), maps.end());
    if (std::ranges::find(all, chosen) == all.end()) {
        all.push_back(chosen);
    }
    if (ImGui::BeginCombo("environment", environmentName(chosen).c_str())) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));  // two maps may have one name
            if (ImGui::Selectable(environmentName(all[i]).c_str(), all[i] == chosen)) {
                chosen = all[i];
            }
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    return chosen;
}

void changeEnvironment(const SceneFigures& figures, LoadOptions& load)
{
    load.environment = environmentCombo(figures.maps, load.environment);
    if (!figures.hasEnvironment) {
        return;
    }
    if (figures.hasMap) {
        ImGui::SliderFloat("rotation", &load.environmentRotation, -180.0F, 180.0F, "%.1f deg", ImGuiSliderFlags_NoInput);
    }
    ImGui::SliderFloat("strength", &load.environmentStrength, kLeastStrength, kMostStrength, "%.3g",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoInput);
    ImGui::Checkbox("the camera sees it", &load.environmentBackground);
}

void changeSun(SceneChoices& choices)
{
    bool shines = choices.load.sun.has_value();
    ImGui::Checkbox("sun", &shines);
    if (!shines) {
        choices.load.sun.reset();
        choices.dragsSun = false;
        return;
    }
    Sun& sun = choices.load.sun ? *choices.load.sun : choices.load.sun.emplace(kFirstSun);
    ImGui::SameLine();
    ImGui::Checkbox("drags move it", &choices.dragsSun);
    const double left = -kHalfTurn, right = kHalfTurn, nadir = -kZenith, zenith = kZenith;
    ImGui::SliderScalar("azimuth", ImGuiDataType_Double, &sun.azimuth, &left, &right, "%.1f deg", ImGuiSliderFlags_NoInput);
    ImGui::SliderScalar("elevation", ImGuiDataType_Double, &sun.elevation, &nadir, &zenith, "%.1f deg", ImGuiSliderFlags_NoInput);
    ImGui::SliderFloat("irradiance", &sun.irradiance, kLeastIrradiance, kMostIrradiance, "%.3g W/m^2",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoInput);
}

std::string variantCombo(const std::vector<std::string>& variants, std::string chosen)
{
    constexpr const char* kOwn = "the file's own";
    if (ImGui::BeginCombo("variant", chosen.empty() ? kOwn : chosen.c_str())) {
        if (ImGui::Selectable(kOwn, chosen.empty())) {
            chosen.clear();
        }
        for (std::size_t i = 0; i < variants.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));  // a name may have ImGui's signs for an id
            if (ImGui::Selectable(variants[i].c_str(), variants[i] == chosen)) {
                chosen = variants[i];
            }
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    return chosen;
}

void changeFloor(LoadOptions& load)
{
    const auto catcher = std::ranges::find(load.catchers, kFloorName);
    bool isThere = load.floor.has_value(), catches = catcher != load.catchers.end();
    ImGui::Checkbox("floor", &isThere);
    if (isThere) {
        SceneFloor& floor = load.floor ? *load.floor : load.floor.emplace();
        ImGui::SameLine();
        ImGui::Checkbox("catches shadows alone", &catches);
        ImGui::ColorEdit3("colour", &floor.color.r, ImGuiColorEditFlags_Float);
    } else {
        load.floor.reset();
    }
    if (!(isThere && catches) && catcher != load.catchers.end()) {
        load.catchers.erase(catcher);
    } else if (isThere && catches && catcher == load.catchers.end()) {
        load.catchers.emplace_back(kFloorName);
    }
}

}  // namespace

std::vector<std::filesystem::path> findMaps(const std::filesystem::path& scene, const LoadOptions& options)
{
    std::vector<std::filesystem::path> maps;
    const auto* chosen = options.environment ? std::get_if<std::filesystem::path>(&*options.environment) : nullptr;
    std::error_code unreadable;
    for (const auto& entry : std::filesystem::directory_iterator(scene.has_parent_path() ? scene.parent_path() : ".", unreadable)) {
        const bool isChosen = chosen && std::filesystem::equivalent(entry.path(), *chosen, unreadable);
        if (entry.path().extension() == ".hdr" && !isChosen) {
            maps.push_back(scene.has_parent_path() ? entry.path() : entry.path().filename());
        }
    }
    std::ranges::sort(maps);
    if (chosen) {
        maps.insert(maps.begin(), *chosen);
    }
    return maps;
}

Sun dragSun(const Sun& sun, const glm::dvec2& motion, double height)
{
    const double perPixel = kHalfTurn / height;
    return {std::remainder(sun.azimuth + motion.x * perPixel, 2.0 * kHalfTurn),
            std::clamp(sun.elevation - motion.y * perPixel, -kZenith, kZenith), sun.irradiance};
}

SceneChoices showScene(const SceneFigures& figures, SceneChoices choices)
{
    if (beginSidePanel("scene")) {
        changeEnvironment(figures, choices.load);
        changeSun(choices);
        if (!figures.variants.empty()) {
            choices.load.variant = variantCombo(figures.variants, choices.load.variant);
        }
        changeFloor(choices.load);
    }
    endPanel();
    return choices;
}

}  // namespace glim
