#include "host/preview/panels.hpp"

#include "host/image/png.hpp"
#include "host/text.hpp"
#include "host/window/widgets.hpp"
#include "shaders/shared/display_colors.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glim {
namespace {

constexpr int kLongestList = 5;   // cameras, before the list scrolls
constexpr float kMapCell = 0.3F;  // in heights of the font: the side of a cell of the guide's map, before it is rounded to pixels
constexpr double kBelow = 0.35;   // how bright directions below the surface are
constexpr float kSlowest = 0.1F, kFastest = 10.0F;   // seconds of the animation a second
constexpr double kNarrowest = 1.0, kWidest = 170.0;  // degrees
constexpr float kPlotHeight = 5.0F;                  // in heights of the font

constexpr HelpLine kHelp[] = {
    {"drag", "orbit"},
    {"shift-drag, middle-drag", "pan"},
    {"wheel", "nearer, farther"},
    {"W A S D Q E", "fly: forward, left, back, right, down, up"},
    {"F", "frame the scene"},
    {"R, 1-9", "the file's camera, its others"},
    {"+ -", "exposure"},
    {"T, V", "next tone, next layer"},
    {"N", "denoise what is left alone, or not"},
    {"G", "what the guide knows under the mouse (--guiding on)"},
    {"click", "print what is there, and change it in the panel"},
    {"Z", "undo the last change"},
    {"O", "focus on the next click"},
    {"K", "play the animation, or pause it"},
    {"Space", "pause sampling"},
    {"P", "write PNG and EXR"},
    {"C, J", "print what is shown as options, or save it as JSON"},
    {"H", "controls, these keys, nothing"},
    {"F11, Esc", "full screen or not, quit"},
};

const char* getName(const WindowLayer& layer)
{
    constexpr const char* kNames[] = {"shaded", "normal", "depth", "albedo", "BVH steps", "guide", "samples"};
    return layer.isError ? "error" : kNames[static_cast<int>(layer.aov)];
}

std::size_t chooseCamera(const std::vector<std::string>& cameras, std::size_t chosen)
{
    const auto rows = static_cast<float>(std::min<int>(static_cast<int>(cameras.size()), kLongestList));
    const float height = rows * ImGui::GetTextLineHeightWithSpacing() + 2.0F * ImGui::GetStyle().FramePadding.y;
    if (ImGui::BeginListBox("camera", {0.0F, height})) {
        for (std::size_t i = 0; i < cameras.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));  // two cameras may have one name
            if (ImGui::Selectable((std::to_string(i + 1) + " " + cameras[i]).c_str(), i == chosen)) {
                chosen = i;
            }
            ImGui::PopID();
        }
        ImGui::EndListBox();
    }
    return chosen;
}

// Both axes are logarithmic: where the error falls as one over the samples, the curve is a straight line.
void plotErrors(const std::vector<ErrorPoint>& points)
{
    const ImVec2 size(ImGui::GetContentRegionAvail().x, kPlotHeight * ImGui::GetFontSize());
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::Dummy(size);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg));
    double high = 0.0, low = std::numeric_limits<double>::infinity();
    for (const ErrorPoint& point : points) {
        high = std::max(high, point.relMse);
        low = std::min(low, point.relMse);
    }
    // Lengths of the axes in logarithms: with one point they are some small number, by which it can be divided.
    const double begin = std::log(points.front().seconds), end = std::max(begin + 1e-3, std::log(points.back().seconds));
    const double top = std::log(high), bottom = std::min(top - 1e-3, std::log(low));
    const float margin = 0.25F * ImGui::GetFontSize();
    std::vector<ImVec2> curve;
    for (const ErrorPoint& point : points) {
        const auto x = static_cast<float>((std::log(point.seconds) - begin) / (end - begin));
        const auto y = static_cast<float>((top - std::log(point.relMse)) / (top - bottom));
        curve.emplace_back(corner.x + margin + x * (size.x - 2.0F * margin), corner.y + margin + y * (size.y - 2.0F * margin));
    }
    const ImU32 color = ImGui::GetColorU32(ImGuiCol_PlotLines);
    list.AddPolyline(curve.data(), static_cast<int>(curve.size()), color, ImDrawFlags_None, 1.5F);
    for (const ImVec2& at : curve) {
        list.AddCircleFilled(at, 0.4F * margin + 1.0F, color);
    }
    ImGui::Text("%.3g s to %.3g s, logarithmic", points.front().seconds, points.back().seconds);
}

// Returns the target that the user chooses.
double showErrors(const PanelFigures& figures, const PanelChoices& choices)
{
    if (figures.errors.empty()) {
        ImGui::TextUnformatted("error unknown yet");
    } else {
        ImGui::Text("estimated relMSE %.3g", figures.errors.back().relMse);
        plotErrors(figures.errors);
        ImGui::TextUnformatted(figures.toTarget.c_str());
    }
    const double target = targetSlider(choices.target);
    if (choices.layer.isError) {
        showErrorScale(target);
    }
    return target;
}

void showFigures(const PanelFigures& figures)
{
    ImGui::Text("%u sample%s in %.1f s%s%s", figures.samples, figures.samples == 1 ? "" : "s", figures.seconds,
                figures.state.empty() ? "" : ", ", figures.state.c_str());
    ImGui::Text("%.2f Msamples/s", figures.samplesPerSecond * 1e-6);
    const std::string size = figures.scale == 1 ? "full size" : "1/" + std::to_string(figures.scale) + " size";
    ImGui::Text("%ux%u, %s", figures.size.x, figures.size.y, size.c_str());
    ImGui::TextUnformatted(figures.device.c_str());
}

// By the logarithm of the density: from blue, as if all directions were alike or fewer chosen, to red.
void drawGuide(const GuideMap& map)
{
    const float side = std::max(1.0F, std::round(kMapCell * ImGui::GetFontSize()));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::Dummy({side * GuideMap::kColumns, side * GuideMap::kRows});
    const double highest = std::log(static_cast<double>(map.highestDensity()));
    for (std::size_t i = 0; i < map.cells.size(); ++i) {
        const auto& [density, isBelow] = map.cells[i];
        const double place = placeOnScale(std::log(static_cast<double>(density)), 0.0, highest, kSmallestScale);
        const Rgb8 color = roundToBytes((isBelow ? kBelow : 1.0) * heatColor(place));
        const ImVec2 low(corner.x + side * static_cast<float>(i % GuideMap::kColumns),
                         corner.y + side * static_cast<float>(i / GuideMap::kColumns));
        ImGui::GetWindowDrawList()->AddRectFilled(low, {low.x + side, low.y + side}, IM_COL32(color[0], color[1], color[2], 255));
    }
}

std::string nameOf(const Animation& animation, std::size_t index) { return std::to_string(index) + " " + animation.name; }

TimeChoices changeTime(const std::vector<Animation>& animations, TimeChoices choices)
{
    if (animations.size() > 1 && ImGui::BeginCombo("animation", nameOf(animations[choices.animation], choices.animation).c_str())) {
        for (std::size_t i = 0; i < animations.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));  // a name may have ImGui's signs for an id
            if (ImGui::Selectable(nameOf(animations[i], i).c_str(), i == choices.animation)) {
                choices.animation = i;
            }
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    const double begin = 0.0, end = animations[choices.animation].duration;
    double seconds = choices.seconds.value_or(begin);
    const char* const pattern = choices.seconds ? "%.3f s" : "rest pose";
    if (ImGui::SliderScalar("time", ImGuiDataType_Double, &seconds, &begin, &end, pattern, ImGuiSliderFlags_NoInput)) {
        choices.seconds = seconds;
    }
    ImGui::SliderFloat("speed", &choices.speed, kSlowest, kFastest, "%.2f x", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::Button(choices.plays ? "pause###play" : "play###play")) {
        choices.plays = !choices.plays;
    }
    ImGui::SameLine();
    ImGui::Checkbox("loop", &choices.loops);
    ImGui::SameLine();
    if (ImGui::Button("rest pose")) {
        choices.seconds.reset();
    }
    return choices;
}

PictureSize chooseSize(const std::vector<PictureSize>& sizes, PictureSize chosen)
{
    if (ImGui::BeginCombo("picture", toText(chosen).c_str())) {
        for (const PictureSize& size : sizes) {
            if (ImGui::Selectable(toText(size).c_str(), size == chosen)) {
                chosen = size;
            }
        }
        ImGui::EndCombo();
    }
    return chosen;
}

LensChoices changeLens(float widest, LensChoices choices)
{
    ImGui::SliderFloat("aperture", &choices.radius, 0.0F, widest, choices.radius > 0.0F ? "radius %.3g m" : "pinhole",
                       ImGuiSliderFlags_NoInput);
    if (choices.radius > 0.0F) {
        ImGui::DragFloat("focus", &choices.focalDistance, 0.01F * choices.focalDistance, LensControl::kNearestFocus,
                         LensControl::kFarthestFocus, "%.4g m", ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput);
    }
    ImGui::Checkbox("focus on the next click", &choices.focusesByClick);
    return choices;
}

}  // namespace

std::vector<std::string> PanelMessages::lines() const
{
    std::vector<std::string> lines;
    for (const std::string& line : {stage, trouble, shaders, notice.text()}) {
        if (!line.empty() && std::ranges::find(lines, line) == lines.end()) {
            lines.push_back(line);
        }
    }
    return lines;
}

PanelChoices showControls(const PanelFigures& figures, PanelChoices choices)
{
    if (beginPanel("glim (H: help)###controls")) {
        choices.exposure = exposureSlider(choices.exposure);
        choices.tone = toneCombo(choices.tone);
        choices.layer = choose("layer", figures.layers, choices.layer, [](const WindowLayer& layer) { return getName(layer); });
        choices.camera = chooseCamera(figures.cameras, choices.camera);
        if (choices.fieldOfView) {
            ImGui::SliderScalar("fov", ImGuiDataType_Double, &*choices.fieldOfView, &kNarrowest, &kWidest, "%.1f deg",
                                ImGuiSliderFlags_NoInput);
        }
        if (figures.widestAperture) {
            choices.lens = changeLens(*figures.widestAperture, choices.lens);
        }
        if (!figures.animations.empty()) {
            ImGui::Separator();
            choices.time = changeTime(figures.animations, choices.time);
        }
        if (!figures.surface.name.empty() || figures.surface.hidden > 0) {
            ImGui::Separator();
            choices.surface = changeSurface(figures.surface, choices.surface);
        }
        if (figures.changes > 0) {
            choices.undo = ImGui::Button(("undo (" + counted(figures.changes, "change") + ")###undo").c_str());
        }
        ImGui::Separator();
        choices.picture = chooseSize(figures.sizes, choices.picture);
        showFigures(figures);
        if (!figures.errors.empty() || choices.layer.isError) {
            ImGui::Separator();
            choices.target = showErrors(figures, choices);
        }
        if (figures.canGuide) {
            ImGui::Separator();
            ImGui::Checkbox("guide under the mouse", &choices.showsGuide);
        }
        if (figures.canDenoise) {
            ImGui::Separator();
            ImGui::Checkbox("denoise when left alone", &choices.denoises);
            for (const std::string& line : figures.denoising) {
                ImGui::TextUnformatted(line.c_str());
            }
        }
    }
    endPanel();
    return choices;
}

void showGuide(const std::optional<GuideMap>& map, const std::string& why)
{
    if (beginInset("guide")) {
        if (map) {
            drawGuide(*map);
            ImGui::PushTextWrapPos(ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x);
            ImGui::TextWrapped("guide: %.0f %% of directions are by it, red ones %.3g times as often as uniform ones, blue ones no more",
                               100.0 * static_cast<double>(map->share), static_cast<double>(map->highestDensity()));
            ImGui::TextWrapped("middle: ahead; sides: behind; dark: below the surface");
            ImGui::PopTextWrapPos();
        } else {
            ImGui::TextUnformatted(why.c_str());
        }
    }
    ImGui::End();
}

void showHelp(float below) { showHelp(kHelp, below); }

}  // namespace glim
