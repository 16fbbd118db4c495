#include "host/window/gui.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace glim {
namespace {

constexpr float kFontPixels = 13.0F;  // the height for which ImGui's own font is drawn
constexpr float kShortest = 1e-4F;    // seconds of a frame: ImGui refuses 0

}  // namespace

Gui::Gui(float scale)
    : last_(std::chrono::steady_clock::now())
{
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // the window remembers nothing
    setScale(scale);
}

void Gui::setScale(float scale)
{
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    ImFontConfig font;
    font.SizePixels = std::max(1.0F, std::floor(kFontPixels * scale));
    fonts.AddFontDefault(&font);
    ImGui::GetStyle() = ImGuiStyle();
    ImGui::GetStyle().ScaleAllSizes(scale);
}

Gui::~Gui() { ImGui::DestroyContext(); }

void Gui::point(const Event& event)
{
    ImGuiIO& io = ImGui::GetIO();
    if (event.kind == Event::Kind::FocusLost) {
        std::fill(std::begin(io.MouseDown), std::end(io.MouseDown), false);
        return;
    }
    io.MousePos = {static_cast<float>(event.position.x), static_cast<float>(event.position.y)};
    io.MouseWheel += static_cast<float>(event.notches);
    const bool pressed = event.kind == Event::Kind::ButtonDown;
    if ((pressed || event.kind == Event::Kind::ButtonUp) && event.button < std::ssize(io.MouseDown)) {
        io.MouseDown[event.button] = pressed;
    }
}

void Gui::frame(const glm::uvec2& size, const std::function<void()>& build)
{
    ImGuiIO& io = ImGui::GetIO();
    const auto now = std::chrono::steady_clock::now();
    io.DisplaySize = {static_cast<float>(size.x), static_cast<float>(size.y)};
    io.DeltaTime = std::max(kShortest, std::chrono::duration<float>(now - std::exchange(last_, now)).count());
    ImGui::NewFrame();
    build();
    ImGui::Render();
}

bool Gui::hasMouse() const { return ImGui::GetIO().WantCaptureMouse; }

ImDrawData& Gui::drawn() const { return *ImGui::GetDrawData(); }

}  // namespace glim
