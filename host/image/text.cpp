#include "host/image/text.hpp"

#include <stb/stb_easy_font.h>
#include <glm/glm.hpp>

#include <algorithm>
#include <sstream>
#include <utility>

namespace glim {
namespace {

constexpr std::uint32_t kLineDots = 12, kMarginDots = 4, kTabDots = 150;
constexpr std::uint32_t kShade = 0U | 150U << 8, kInk = 255U | 255U << 8;

// A vertex from stb_easy_font. Four vertices make a rectangle: the first is its least corner, the third its largest.
struct Vertex {
    float x, y, z;
    unsigned char color[4];
};

struct Words {
    std::string text;
    glm::uvec2 place;  // dots from the upper left corner
};

// Replaces characters that the font lacks; its own functions do not check.
std::string printable(std::string line)
{
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return line;
}

// The same for every line, but keeps the first tab of each.
std::vector<std::string> printable(const std::vector<std::string>& lines)
{
    std::vector<std::string> rows;
    for (const std::string& line : lines) {
        rows.push_back(printable(line));
        if (const std::size_t tab = line.find('\t'); tab != std::string::npos) {
            rows.back()[tab] = '\t';
        }
    }
    return rows;
}

void fill(TextBox& box, const glm::uvec2& low, const glm::uvec2& high)
{
    for (std::uint32_t y = low.y; y < std::min(high.y, box.height); ++y) {
        for (std::uint32_t x = low.x; x < std::min(high.x, box.width); ++x) {
            box.pixels[std::size_t{y} * box.width + x] = kInk;
        }
    }
}

// Draws `words` at `place`, which is in dots.
void drawWords(TextBox& box, std::string words, const glm::uvec2& place, std::uint32_t scale)
{
    std::vector<Vertex> vertices(4 * 32 * (words.size() + 1));
    const int quads =
        stb_easy_font_print(0.0F, 0.0F, words.data(), nullptr, vertices.data(), static_cast<int>(vertices.size() * sizeof(Vertex)));
    for (int i = 0; i < quads; ++i) {
        const Vertex &low = vertices[4 * i], &high = vertices[4 * i + 2];
        fill(box, (place + glm::uvec2(low.x, low.y)) * scale, (place + glm::uvec2(high.x, high.y)) * scale);
    }
}

int widthOf(std::string words) { return stb_easy_font_width(words.data()); }  // the library takes no const char*

// Breaks lines between words where they are wider than `dots` less the margins. A single word may stay too long; the picture cuts it.
std::vector<std::string> wrap(const std::vector<std::string>& lines, std::uint32_t dots)
{
    const int most = static_cast<int>(dots) - 2 * static_cast<int>(kMarginDots);
    const auto fits = [most](const std::string& text) { return widthOf(text) <= most; };
    std::vector<std::string> rows;
    for (const std::string& line : lines) {
        std::string row;
        if (line.find('\t') != std::string::npos || fits(line)) {
            row = line;
        } else {
            std::istringstream words(line);
            for (std::string word; words >> word;) {
                if (!row.empty() && !fits(row + " " + word)) {
                    rows.push_back(std::exchange(row, ""));
                }
                row += (row.empty() ? "" : " ") + word;
            }
        }
        rows.push_back(row);
    }
    return rows;
}

}  // namespace

TextBox drawText(const std::vector<std::string>& lines, std::uint32_t scale, std::uint32_t width)
{
    TextBox box;
    const std::vector<std::string> rows = wrap(printable(lines), width / scale);
    if (rows.empty()) {
        return box;
    }
    std::vector<Words> columns;
    int dots = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto y = kMarginDots + static_cast<std::uint32_t>(i) * kLineDots;
        const std::size_t tab = rows[i].find('\t');
        columns.push_back({rows[i].substr(0, tab), {kMarginDots, y}});
        if (tab != std::string::npos) {
            columns.push_back({rows[i].substr(tab + 1), {kMarginDots + kTabDots, y}});
        }
        dots = std::max(dots, static_cast<int>(columns.back().place.x) + widthOf(columns.back().text));
    }
    box.width = (static_cast<std::uint32_t>(dots) + kMarginDots) * scale;
    box.height = (static_cast<std::uint32_t>(rows.size()) * kLineDots + 2 * kMarginDots) * scale;
    box.pixels.assign(std::size_t{box.width} * box.height, kShade);
    for (const Words& words : columns) {
        drawWords(box, words.text, words.place, scale);
    }
    return box;
}

}  // namespace glim
