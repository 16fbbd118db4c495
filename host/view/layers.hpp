// The layers of an EXR file, as a viewer lists them.
#pragma once

#include "host/image/image.hpp"
#include "host/measure/picture.hpp"
#include "host/render/aov.hpp"

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
    bool isLight = false;  // tone mapping applies
};

// R, G, B of one prefix make a layer, with A if there is one, and X, Y, Z do. Each other channel is a layer of its own. They are in the
// order of their prefixes; that of colour has none and is first.
std::vector<Layer> layersOf(const Image& image);

// What the window shows of `layer`, as `radiance`, without variance: its three channels or one of them three times. Vectors of films of
// glim are divided by alpha. A depth that is not finite, 1e9 and more (other renderers' infinity) or where alpha is 0 becomes 0. Ids become
// colours; the largest, which stands for none, becomes black.
Picture valuesOf(const Image& image, const Layer& layer);

// The ends of the scale of depths, which are the nearest and the farthest; or of heat: all counts, or 0 and what 99.9 % of other numbers
// stay below.
DisplayRange rangeOf(const Image& image, const Layer& layer, const Picture& values);

// The numbers of a pixel as the file has them.
std::vector<double> numbersOf(const Image& image, const Layer& layer, std::size_t pixel);
// With six digits, whole numbers with all, as in "0.5 0.25 1"; "-" without numbers.
std::string textOf(const std::vector<double>& numbers);

}  // namespace glim
