#include "host/image/text.hpp"

#include <stb/stb_easy_font.h>

#include <algorithm>

namespace glim {
namespace {

constexpr std::uint32_t kLineDots = 12, kMarginDots = 4;
constexpr std::uint32_t kShade = 0U | 150U << 8, kInk = 255U | 255U << 8;

// What stb_easy_font makes: four of them are a rectangle, beginning with its least corner and with the largest third.
struct Vertex {
    float x, y, z;
    unsigned char color[4];
};

std::string printable(std::string line)
{
    std::replace_if(line.begin(), line.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return line;
}

void drawLine(TextBox& box, const std::string& line, std::uint32_t top, std::uint32_t scale)
{
    std::string text = line;  // the library takes no constants
    std::vector<Vertex> vertices(4 * 32 * (text.size() + 1));
    const int quads = stb_easy_font_print(0.0F, 0.0F, text.data(), nullptr, vertices.data(),
                                          static_cast<int>(vertices.size() * sizeof(Vertex)));
    for (int i = 0; i < quads; ++i) {
        const Vertex &low = vertices[4 * i], &high = vertices[4 * i + 2];
        const auto left = (kMarginDots + static_cast<std::uint32_t>(low.x)) * scale;
        const auto right = (kMarginDots + static_cast<std::uint32_t>(high.x)) * scale;
        const auto above = top + static_cast<std::uint32_t>(low.y) * scale;
        const auto below = top + static_cast<std::uint32_t>(high.y) * scale;
        for (std::uint32_t y = above; y < std::min(below, box.height); ++y) {
            for (std::uint32_t x = left; x < std::min(right, box.width); ++x) {
                box.pixels[std::size_t{y} * box.width + x] = kInk;
            }
        }
    }
}

}  // namespace

TextBox drawText(const std::vector<std::string>& lines, std::uint32_t scale)
{
    TextBox box;
    if (lines.empty()) {
        return box;
    }
    std::vector<std::string> texts;
    int dots = 0;
    for (const std::string& line : lines) {
        texts.push_back(printable(line));
        dots = std::max(dots, stb_easy_font_width(texts.back().data()));
    }
    box.width = (static_cast<std::uint32_t>(dots) + 2 * kMarginDots) * scale;
    box.height = (static_cast<std::uint32_t>(texts.size()) * kLineDots + 2 * kMarginDots) * scale;
    box.pixels.assign(std::size_t{box.width} * box.height, kShade);
    for (std::size_t i = 0; i < texts.size(); ++i) {
        drawLine(box, texts[i], (kMarginDots + static_cast<std::uint32_t>(i) * kLineDots) * scale, scale);
    }
    return box;
}

}  // namespace glim
