// The viewer's panel.
#pragma once

#include "host/render/aov.hpp"

#include <string>
#include <vector>

namespace glim {

enum class Side { A, B, Difference };

// What the user changes in the panel.
struct ViewChoices {
    std::size_t layer = 0;
    Side side = Side::A;
    double exposure = 0.0;  // stops
    Tone tone = Tone::None;
    std::vector<double> lights;  // factors of A's light groups
    bool operator==(const ViewChoices&) const = default;
};

// What else the panel shows.
struct ViewFigures {
    std::vector<std::string> layers;
    std::vector<Side> sides;          // that the layer has
    bool isExposed = false;           // whether the exposure changes the picture
    bool isToned = false;             // the same of the tone
    std::vector<std::string> lights;  // A's light groups
    std::vector<std::string> lines;   // of text
};

// Call these inside a frame (host/window/gui.hpp). showViewPanel returns `choices` with what the user changes in it.
ViewChoices showViewPanel(const ViewFigures& figures, ViewChoices choices);
// Above the messages, whose height is `below`.
void showViewHelp(float below);

}  // namespace glim
