// Text drawn as pixels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace glim {

// Lies over the upper left corner of a picture.
struct TextBox {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint32_t> pixels;  // rows from the top: brightness | opacity << 8, both 0 to 255
};

// Draws white text on a dark shade. A dot of the font is `scale` pixels wide; a line is 12 dots high. Bytes that are not printable
// ASCII show as "?". The text after a tab stands in a second column. A line without a tab is broken where it exceeds `width` pixels.
// The box is empty if there are no lines.
TextBox drawText(const std::vector<std::string>& lines, std::uint32_t scale, std::uint32_t width);

}  // namespace glim
