// Parts of the panels over a window's picture. Call these inside a frame (gui.hpp).
#pragma once

#include "host/render/aov.hpp"
#include "host/window/viewport.hpp"

#include <imgui.h>

#include <span>
#include <string>
#include <vector>

namespace glim {

// The panel of controls, in the upper left corner at first. Returns whether its contents show; endPanel follows in any case.
bool beginPanel(const char* title);
// The same in the lower right corner, closed at first.
bool beginSidePanel(const char* title);
void endPanel();

// Dark grey behind all panels and beside this part of the window.
void fillBeside(const Rectangle& shown);

// A panel in the upper right corner, which the mouse does not meet. ImGui::End follows in any case.
bool beginInset(const char* title);

// Lets the user choose among `values`, by the names that `name` gives.
template <class Value, class Name>
Value choose(const char* label, const std::vector<Value>& values, Value chosen, Name&& name)
{
    if (ImGui::BeginCombo(label, name(chosen))) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));  // two values may have one name
            if (ImGui::Selectable(name(values[i]), values[i] == chosen)) {
                chosen = values[i];
            }
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    return chosen;
}
double exposureSlider(double stops);
Tone toneCombo(Tone chosen);

struct HelpLine {
    const char *key, *meaning;
};
// In the upper left corner, in place of the panel of controls. The text is smaller where the window has no room for it above the messages,
// whose height is `below`.
void showHelp(std::span<const HelpLine> lines, float below);
// In the lower left corner. Nothing if there are no lines. Returns the height of their panel.
float showMessages(const std::vector<std::string>& lines);

}  // namespace glim
