// Text as pixels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace glim {

// Covers a picture from its upper left corner on.
struct TextBox {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint32_t> pixels;  // rows from the top: brightness | opacity << 8, both 0 to 255
};

// White on a dark shade, `scale` pixels to a dot of the font (lines are 12 dots high); nothing if there are no lines. What is not
// printable ASCII shows as "?"; what follows a tab stands in a second column; lines without one go on below where `width` pixels
// are not enough.
TextBox drawText(const std::vector<std::string>& lines, std::uint32_t scale, std::uint32_t width);

}  // namespace glim
