// Parses the values of options. One that is not valid throws UsageError, which names what was expected.
#pragma once

#include "host/job/option_table.hpp"
#include "host/render/regroup.hpp"
#include "host/scene/load_gltf.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glim {

// The largest sample index + 1: the sampler keeps one bit of the block number for itself.
inline constexpr std::uint32_t kMaxSample = 1U << 31;

// Pixels along a side: what fits OpenEXR viewers and keeps width * height within 32 bits.
inline constexpr std::uint32_t kMaxSide = 65535;

// Sample `sample` of the pixel in column x and row y, from the upper left corner.
struct SamplePlace {
    std::uint32_t x, y, sample;
};

// Frames `first`, `first` + `step` ... up to `last`.
struct FrameRange {
    std::uint32_t first = 0, last = 0, step = 1;
};

glm::uvec2 parseSize(const OptionValue& value, const std::string& option = "--size");  // "640x480"
// "0:256", begin < end <= most.
std::pair<std::uint32_t, std::uint32_t> parseRange(const std::string& option, const OptionValue& value, std::uint32_t most);
FrameRange parseFrames(const OptionValue& value);  // "1:250" or "1:250:5", first <= last
// "none", "studio", numbers or a file.
EnvironmentChoice parseEnvironment(const OptionValue& value);
std::string describeEnvironment(const EnvironmentChoice& choice);
Sun parseSun(const OptionValue& value);  // "30,45,1000"
std::string describeSun(const Sun& sun);
std::optional<double> parseFloorHeight(const OptionValue& value);                 // "0.5"; nothing for "lowest"
glm::vec3 parseReflectance(const std::string& option, const OptionValue& value);  // "0.8,0.5,0.1"
glm::vec3 parseRadiance(const OptionValue& value);                                // "1,1,1", >= 0; a file is refused
Edit parseEdit(const OptionValue& value);                                         // "POINTER=VALUE", or a value whose key is the pointer
void parseLightGroup(const OptionValue& value, LightGroupChoice& choice);         // "NAME=LIGHT,LIGHT*" or "each"; added to `choice`
LightWeight parseLightWeight(const OptionValue& value);                           // "NAME=0.5" or "NAME=1,0.5,0", >= 0
Addition parseAddition(const OptionValue& value);                                 // "FILE", "FILE@x,y,z", or numbers whose key is the file
std::string describeAddition(const Addition& addition);
SamplePlace parseSample(const OptionValue& value);                           // "12,40,7"
glm::uvec2 parsePixel(const std::string& option, const OptionValue& value);  // "12,40", from the upper left corner
glm::dvec3 parsePoint(const std::string& option, const OptionValue& value);  // "1,2.5,-3"
// Finite numbers, as many as one of `counts` says; `expected` describes them in messages.
std::vector<double> parseNumbers(const std::string& option, const OptionValue& value, const std::vector<std::size_t>& counts,
                                 const std::string& expected);
Shutter parseShutter(const OptionValue& value);  // "0,0.02", in seconds
std::string describeShutter(const Shutter& shutter);
double parsePercent(const std::string& option, const OptionValue& value);   // "1%", in (0, 1000]; returns 1 for 100%
double parseDuration(const std::string& option, const OptionValue& value);  // "90s", "5m" or "1h", > 0; returns seconds
std::optional<double> parseExposure(const OptionValue& value);              // "-1.5", in stops; nothing for "auto"
float parseSurvival(const OptionValue& value);                              // "fixed:0.7", in (0, 1]

// An option whose value is one number (uint32_t, float or double) in [low, high]; never NaN. The help shows `what`, the range and, in
// brackets, the default.
template <class T>
struct NumberOption {
    std::string name, unit, what;
    T low, high;
    std::string fallback;
};
template <class T>
Option addNumber(OptionTable& table, const NumberOption<T>& option, std::function<void(T)> store);

// An option whose value is one of `names`; `store` gets its place in that list.
Option addChoice(OptionTable& table, const std::string& name, const std::string& unit, const std::string& help,
                 const std::vector<std::string>& names, std::function<void(std::size_t)> store);

// `names` in the order of the enumeration.
template <class Enum>
Option addEnum(OptionTable& table, const std::string& name, const std::string& unit, const std::string& help,
               const std::vector<std::string>& names, Enum& value)
{
    return addChoice(table, name, unit, help, names, [&value](std::size_t i) { value = static_cast<Enum>(i); });
}

// --scene of render and inspect.
Option addSceneIndex(OptionTable& table, std::optional<std::size_t>& index);

}  // namespace glim
