#include "host/preview/picture_size.hpp"

#include <algorithm>

namespace glim {

// Half of a window with an odd side leaves a row beside it, so that a pixel of the picture has four of the window.
glm::uvec2 sizeIn(const PictureSize& size, const glm::uvec2& window) { return size.own.value_or(glm::max(window / size.divisor, 1U)); }

std::string toText(const PictureSize& size)
{
    if (size.own) {
        return std::to_string(size.own->x) + "x" + std::to_string(size.own->y);
    }
    return size.divisor == 1 ? "as the window" : "half of the window";
}

std::vector<PictureSize> choicesOfSize(const PictureSize& first)
{
    std::vector<PictureSize> sizes{
        {}, {{}, 2}, {glm::uvec2(1920, 1080)}, {glm::uvec2(1280, 720)}, {glm::uvec2(1024, 1024)}, {glm::uvec2(512, 512)}};
    if (std::ranges::find(sizes, first) == sizes.end()) {
        sizes.push_back(first);
    }
    return sizes;
}

}  // namespace glim
