// Pixels and the coordinates of a screen. They differ where a display with small pixels counts several as one, as on Wayland and macOS.
#pragma once

#include <glm/glm.hpp>

namespace glim {

struct PixelScale {
    glm::dvec2 pixels{1.0};  // for a coordinate of the screen

    // Of a window with these sizes; 1 if it has no area.
    static PixelScale of(const glm::ivec2& onScreen, const glm::uvec2& inPixels)
    {
        return {glm::max(glm::dvec2(inPixels), 1.0) / glm::max(glm::dvec2(onScreen), 1.0)};
    }
    glm::dvec2 toPixels(const glm::dvec2& onScreen) const { return onScreen * pixels; }
    glm::dvec2 toScreen(const glm::dvec2& inPixels) const { return inPixels / pixels; }
    // Of a window: at least 1.
    glm::ivec2 toScreen(const glm::uvec2& inPixels) const { return glm::max(glm::ivec2(glm::round(glm::dvec2(inPixels) / pixels)), 1); }
};

}  // namespace glim
