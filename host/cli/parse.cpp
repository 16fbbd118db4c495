#include "host/cli/parse.hpp"

#include <CLI/CLI.hpp>

#include <charconv>
#include <cmath>
#include <vector>

namespace glim {
namespace {

// Pixels along a side: what fits OpenEXR viewers and keeps width * height within 32 bits.
constexpr std::uint32_t kMaxSide = 65535;

// The whole of `text` as a number, or nothing.
template <class T>
bool parseNumber(const std::string& text, T& value)
{
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc{} && stop == end && !text.empty();
}

std::vector<std::string> split(const std::string& text, char separator)
{
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == separator) {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    return parts;
}

}  // namespace

glm::uvec2 parseSize(const std::string& text)
{
    const std::vector<std::string> parts = split(text, 'x');
    glm::uvec2 size(0);
    if (parts.size() != 2 || !parseNumber(parts[0], size.x) || !parseNumber(parts[1], size.y) || size.x == 0 ||
        size.y == 0 || size.x > kMaxSide || size.y > kMaxSide) {
        throw CLI::ValidationError("--size", "\"" + text + "\": expected WIDTHxHEIGHT in pixels, each 1 to " +
                                                 std::to_string(kMaxSide) + ", as in 640x480");
    }
    return size;
}

std::pair<std::uint32_t, std::uint32_t> parseRange(const std::string& text)
{
    const std::vector<std::string> parts = split(text, ':');
    std::pair<std::uint32_t, std::uint32_t> range;
    if (parts.size() != 2 || !parseNumber(parts[0], range.first) || !parseNumber(parts[1], range.second) ||
        range.first >= range.second || range.second > kMaxSample) {
        throw CLI::ValidationError("--samples", "\"" + text + "\": expected BEGIN:END with BEGIN < END <= " +
                                                    std::to_string(kMaxSample) + ", as in 0:256");
    }
    return range;
}

glm::vec3 parseRadiance(const std::string& text)
{
    const std::vector<std::string> parts = split(text, ',');
    glm::vec3 radiance(0.0F);
    bool valid = parts.size() == 3;
    for (int k = 0; valid && k < 3; ++k) {
        valid = parseNumber(parts[static_cast<std::size_t>(k)], radiance[k]) && std::isfinite(radiance[k]) &&
                radiance[k] >= 0.0F;
    }
    if (!valid) {
        throw CLI::ValidationError("--environment",
                                   "\"" + text + "\": expected a constant radiance as r,g,b with numbers >= 0, as in "
                                                 "1,1,1 (environment maps are not supported yet)");
    }
    return radiance;
}

}  // namespace glim
