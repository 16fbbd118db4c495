// The layers of an EXR file, as a viewer lists them.
#pragma once

#include "host/image/image.hpp"
#include "host/measure/picture.hpp"
#include "host/render/aov.hpp"

#include <optional>
#include <string>
#include <vector>

namespace glim {

// The first five values are those of kShownAsColor ... (shaders/shared/display_types.h).
enum class ShownAs : std::uint32_t {
    Color,
    Vector,
    Depth,
    Heat,
    Difference,
    Ids,  // as the colours of their hashes
};

struct Layer {
    std::string name;                   // "color" for R, G, B without a prefix
    std::vector<std::string> channels;  // one or three, and alpha if colours have it
    ShownAs shownAs = ShownAs::Color;
    bool isExposed = false, isToned = false;  // whether exposure and tone change it
};

// R, G, B of one prefix make a layer, with A if there is one, and so do X, Y, Z. Each other channel is a layer of its own. They are in the
// order of their prefixes. Colour has none and comes first.
std::vector<Layer> collectLayers(const Image& image);

// What the window shows of `layer`, as `radiance`, without variance: its three channels or one of them three times. Vectors of films of
// glim are divided by alpha. A depth becomes 0 if it is infinite, if it is 1e9 or more (so others write that nothing is there), or if alpha
// is 0. Ids become colours; the largest stands for none and becomes black.
Picture valuesOf(const Image& image, const Layer& layer);

// The alpha of a film whose background is hidden, as `radiance`; empty of others. All its layers of colours are multiplied by it.
Picture alphaOf(const Image& image);

// The ends of the scale of depths and heat; nothing for other layers, and if no value is finite. Of depths and counts: the least and the
// most. Of other numbers: 0, or the least if that is negative, and what 99.9 % stay below.
std::optional<DisplayRange> getRange(const Image& image, const Layer& layer, const Picture& values);

// The numbers of a pixel as the file has them.
std::vector<double> numbersOf(const Image& image, const Layer& layer, std::size_t pixel);
// With six digits, whole numbers with all, as in "0.5 0.25 1"; "-" without numbers.
std::string toText(const std::vector<double>& numbers);

}  // namespace glim
