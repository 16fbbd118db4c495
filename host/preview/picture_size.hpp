// How large the picture is: as the window, or of a size of its own.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glim {

struct PictureSize {
    std::optional<glm::uvec2> own;  // pixels; absent: it follows the window
    std::uint32_t divisor = 1;      // of the window's size

    bool operator==(const PictureSize&) const = default;
};

// In pixels, in a window of this size.
glm::uvec2 sizeIn(const PictureSize& size, const glm::uvec2& window);

// "as the window", "1920x1080".
std::string toText(const PictureSize& size);

// What the panel offers: sizes that are usual, and the `first`, that of the start.
std::vector<PictureSize> choicesOfSize(const PictureSize& first);

}  // namespace glim
