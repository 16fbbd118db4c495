// Option values. Whatever is no value of the option throws CLI::ValidationError (exit code 2) naming what was expected.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}

namespace glim {

// The largest sample index + 1: the sampler keeps one bit of the block number for itself.
inline constexpr std::uint32_t kMaxSample = 1U << 31;

// Sample `sample` of the pixel in column x and row y, from the upper left corner.
struct SamplePlace {
    std::uint32_t x, y, sample;
};

glm::uvec2 parseSize(const std::string& text);                                 // "640x480"
std::pair<std::uint32_t, std::uint32_t> parseRange(const std::string& text);   // "0:256", begin < end
glm::vec3 parseRadiance(const std::string& text);                              // "1,1,1", >= 0; a file is refused
SamplePlace parseSample(const std::string& text);                                // "12,40,7"
glm::dvec3 parsePoint(const std::string& option, const std::string& text);     // "1,2.5,-3"
double parsePercent(const std::string& option, const std::string& text);       // "1%", of (0, 1000]; 1 for 100%
float parseSurvival(const std::string& text);                                  // "fixed:0.7", of (0, 1]

// An option whose value is one number (uint32_t, float or double) of [low, high]; never NaN. The help says `what`, the
// range and, in brackets, what holds without the option.
template <class T>
struct NumberOption {
    std::string name, unit, what;
    T low, high;
    std::string fallback;
};
template <class T>
CLI::Option* addNumber(CLI::App& command, const NumberOption<T>& option, std::function<void(T)> store);

// An option whose value is one of `names`; `store` gets its place in that list.
CLI::Option* addChoice(CLI::App& command, const std::string& name, const std::string& unit, const std::string& help,
                       const std::vector<std::string>& names, std::function<void(std::size_t)> store);

// `names` in the order of the enumeration.
template <class Enum>
CLI::Option* addEnum(CLI::App& command, const std::string& name, const std::string& unit, const std::string& help,
                     const std::vector<std::string>& names, Enum& value)
{
    return addChoice(command, name, unit, help, names, [&value](std::size_t i) { value = static_cast<Enum>(i); });
}

// --exposure, in stops, of `picture`, as in "a PNG".
CLI::Option* addExposure(CLI::App& command, double& exposure, const std::string& picture);

// --scene of render and inspect.
CLI::Option* addSceneIndex(CLI::App& command, std::optional<std::size_t>& index);

}  // namespace glim
