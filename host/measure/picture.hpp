// The pictures that are compared: radiance and, where it is known, its variance.
#pragma once

#include "host/image/image.hpp"
#include "host/render/film.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace glim {

// Of the blocks of pixels whose means are taken for independent and near enough to normal, in pixels.
inline constexpr std::uint32_t kBlockSide = 8;

struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<glm::vec3> radiance;               // row 0 at the top, left to right
    std::vector<glm::vec3> variance;               // of each radiance as a mean; NaN: unknown there; empty: unknown
    std::uint32_t rowsAbove = 0, columnsLeft = 0;  // of the whole, which this lacks
};

Picture makePicture(const Film& film);

// The channels R, G, B and, if there are, variance.R, .G, .B. `name` is for the message of InputError.
Picture makePicture(const Image& image, const std::string& name);

// Sets the variance of `picture` to R, G and B of `image`.
void setVariance(Picture& picture, const Image& image, const std::string& name);

bool isFinite(const glm::dvec3& value);

}  // namespace glim
