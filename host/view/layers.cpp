#include "host/view/layers.hpp"

#include "shaders/shared/display_types.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>

namespace glim {
namespace {

static_assert(static_cast<std::uint32_t>(ShownAs::Color) == kShownAsColor &&
              static_cast<std::uint32_t>(ShownAs::Vector) == kShownAsVector &&
              static_cast<std::uint32_t>(ShownAs::Depth) == kShownAsDepth && static_cast<std::uint32_t>(ShownAs::Heat) == kShownAsHeat &&
              static_cast<std::uint32_t>(ShownAs::Difference) == kShownAsDifference);

constexpr float kFarthestDepth = 1e9F;  // of a surface; other renderers write 1e10 where there is none

const std::set<std::string> kErrors{"error", "denoisedError", "variance", "squares"}, kIds{"node", "mesh", "material"};

// The last part of a name with dots.
std::string lastPart(const std::string& name)
{
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos || dot == 0 ? name : name.substr(dot + 1);
}

// A layer's channels by the last part of their names.
using Channels = std::map<std::string, std::string>;

// What is in front of the last part, of all channels.
std::map<std::string, Channels> channelsByPrefix(const Image& image)
{
    std::map<std::string, Channels> prefixes;
    const auto add = [&prefixes](const std::string& channel) {
        const std::string last = lastPart(channel);
        const std::string prefix = last.size() < channel.size() ? channel.substr(0, channel.size() - last.size() - 1) : "";
        prefixes[prefix][last] = channel;
    };
    for (const auto& [channel, plane] : image.channels) {
        add(channel);
    }
    for (const auto& [channel, plane] : image.counts) {
        add(channel);
    }
    return prefixes;
}

// Moves three channels of these names into a layer, if they are there.
std::optional<Layer> takeThree(Channels& channels, const std::string& prefix, const char* letters, ShownAs shownAs)
{
    Layer layer{prefix.empty() ? "color" : prefix, {}, shownAs};
    for (int c = 0; c < 3; ++c) {
        const auto found = channels.find(std::string(1, letters[c]));
        if (found == channels.end()) {
            return std::nullopt;
        }
        layer.channels.push_back(found->second);
    }
    if (const auto alpha = channels.find("A"); alpha != channels.end() && letters[0] == 'R') {
        layer.channels.push_back(alpha->second);
        channels.erase(alpha);
    }
    for (int c = 0; c < 3; ++c) {
        channels.erase(std::string(1, letters[c]));
    }
    return layer;
}

Layer single(const Image& image, const std::string& prefix, const std::string& channel, bool isAlone)
{
    const std::string last = lastPart(channel);
    Layer layer{isAlone && !prefix.empty() ? prefix : channel, {channel}, ShownAs::Heat};
    if (kIds.contains(prefix) && image.counts.contains(channel)) {
        layer.shownAs = ShownAs::Ids;
    } else if (last == "Z") {
        layer.shownAs = ShownAs::Depth;
    } else if (last == "Y" && isAlone) {  // luminance
        layer.shownAs = ShownAs::Color;
        layer.isExposed = layer.isToned = true;
    }
    return layer;
}

// A channel of either kind.
class Plane {
public:
    Plane(const Image& image, const std::string& channel)
        : floats_(image.channels.contains(channel) ? image.channels.at(channel).data() : nullptr),
          counts_(floats_ == nullptr ? image.counts.at(channel).data() : nullptr)
    {}
    float operator[](std::size_t pixel) const { return floats_ != nullptr ? floats_[pixel] : static_cast<float>(counts_[pixel]); }

private:
    const float* floats_;
    const std::uint32_t* counts_;
};

// Knuth's multiplicative hash, a byte a channel.
glm::vec3 colorOf(std::uint32_t id)
{
    if (id == std::numeric_limits<std::uint32_t>::max()) {
        return glm::vec3(0.0F);
    }
    const std::uint32_t hash = (id + 1U) * 2654435761U;
    return glm::vec3(hash >> 24U, hash >> 16U & 255U, hash >> 8U & 255U) / 255.0F;
}

// Where alpha is known and 0, nothing was met.
float depthOf(float depth, float alpha) { return alpha > 0.0F && !(std::abs(depth) >= kFarthestDepth) ? depth : 0.0F; }

float meanOfChannels(const glm::vec3& value) { return (value.x + value.y + value.z) / 3.0F; }

}  // namespace

std::vector<Layer> collectLayers(const Image& image)
{
    std::vector<Layer> layers;
    for (auto& [prefix, channels] : channelsByPrefix(image)) {
        const std::string last = lastPart(prefix);
        const bool isAlone = channels.size() == 1;
        if (auto color = takeThree(channels, prefix, "RGB", kErrors.contains(last) ? ShownAs::Heat : ShownAs::Color)) {
            color->isExposed = color->shownAs == ShownAs::Color && !last.starts_with("Crypto");
            color->isToned = color->isExposed && last != "albedo";
            layers.push_back(*color);
        } else if (auto vector = takeThree(channels, prefix, "XYZ", ShownAs::Vector)) {
            layers.push_back(*vector);
        }
        for (const auto& [name, channel] : channels) {
            layers.push_back(single(image, prefix, channel, isAlone));
        }
    }
    return layers;
}

Picture valuesOf(const Image& image, const Layer& layer)
{
    Picture values{image.width, image.height, {}, {}, image.rowsAbove, image.columnsLeft};
    values.radiance.resize(std::size_t{image.width} * image.height);
    const auto plane = [&](std::size_t c) { return Plane(image, layer.channels[std::min(c, layer.channels.size() - 1)]); };
    const std::array<Plane, 3> planes{plane(0), plane(1), plane(2)};
    const std::uint32_t* ids = layer.shownAs == ShownAs::Ids ? image.counts.at(layer.channels[0]).data() : nullptr;
    const auto alphas = image.channels.find("A");
    const bool isFilm = image.attributes.contains("glim:film");
    for (std::size_t i = 0; i < values.radiance.size(); ++i) {
        const float alpha = alphas == image.channels.end() ? 1.0F : alphas->second[i];
        glm::vec3& value = values.radiance[i];
        value = {planes[0][i], planes[1][i], planes[2][i]};
        if (ids != nullptr) {
            value = colorOf(ids[i]);
        } else if (layer.shownAs == ShownAs::Depth) {
            value = glm::vec3(depthOf(value.x, alpha));
        } else if (layer.shownAs == ShownAs::Vector && isFilm) {
            value = alpha > 0.0F ? value / alpha : glm::vec3(0.0F);
        }
    }
    return values;
}

Picture alphaOf(const Image& image)
{
    const auto found = image.attributes.find("glim:background");
    const auto* const background = found == image.attributes.end() ? nullptr : std::get_if<std::string>(&found->second);
    const bool isHidden = background != nullptr && *background == "off" && image.channels.contains("A");
    return isHidden ? valuesOf(image, {"alpha", {"A"}, ShownAs::Heat}) : Picture{};
}

std::optional<DisplayRange> getRange(const Image& image, const Layer& layer, const Picture& values)
{
    const bool isDepth = layer.shownAs == ShownAs::Depth;
    if (!isDepth && layer.shownAs != ShownAs::Heat) {
        return std::nullopt;
    }
    std::vector<float> numbers;
    for (const glm::vec3& value : values.radiance) {
        const float number = isDepth ? value.x : meanOfChannels(value);
        if (std::isfinite(number) && !(isDepth && number == 0.0F)) {
            numbers.push_back(number);
        }
    }
    if (numbers.empty()) {
        return std::nullopt;
    }
    const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
    if (isDepth || image.counts.contains(layer.channels[0])) {
        return DisplayRange{*least, *most};
    }
    const float low = std::min(0.0F, *least);
    const auto high = numbers.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(numbers.size() - 1));
    std::nth_element(numbers.begin(), high, numbers.end());
    return DisplayRange{low, *high};
}

std::vector<double> numbersOf(const Image& image, const Layer& layer, std::size_t pixel)
{
    std::vector<double> numbers;
    for (const std::string& channel : layer.channels) {
        const auto counts = image.counts.find(channel);
        const bool isCount = counts != image.counts.end();
        numbers.push_back(isCount ? static_cast<double>(counts->second[pixel]) : static_cast<double>(image.channels.at(channel)[pixel]));
    }
    return numbers;
}

std::string toText(const std::vector<double>& numbers)
{
    constexpr double kLargestWhole = 4294967296.0;
    std::string text;
    for (const double number : numbers) {
        char digits[32];
        const bool isWhole = number == std::floor(number) && std::abs(number) < kLargestWhole;
        std::snprintf(digits, sizeof digits, isWhole ? "%.0f" : "%.6g", number);
        text += (text.empty() ? "" : " ") + std::string(digits);
    }
    return text.empty() ? "-" : text;
}

}  // namespace glim
