#include "host/measure/picture.hpp"

#include "host/error.hpp"

#include <cmath>
#include <limits>

namespace glim {
namespace {

std::vector<glm::vec3> colors(const Image& image, const std::string& layer, const std::string& name)
{
    std::vector<glm::vec3> values(std::size_t{image.width} * image.height);
    const std::string letters = "RGB";
    for (int c = 0; c < 3; ++c) {
        const std::string channel = layer + letters[static_cast<std::size_t>(c)];
        const auto plane = image.channels.find(channel);
        if (plane == image.channels.end()) {
            throw InputError(MessageId::Missing, {part::file(name), ": has no half or float channel ", part::place(channel), ", expected ",
                                                  part::expected(layer + "R, " + layer + "G and " + layer + "B"), "."});
        }
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i][c] = plane->second[i];
        }
    }
    return values;
}

// A film's file has infinity where fewer than two blocks tell nothing, and where a square overflowed.
void clearUnknown(std::vector<glm::vec3>& variance, const std::vector<std::uint32_t>& blocks)
{
    for (std::size_t i = 0; i < variance.size(); ++i) {
        if (blocks[i] < 2) {
            variance[i] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
        }
    }
}

}  // namespace

Picture makePicture(const Film& film)
{
    const glm::uvec2 corner = film.crop ? film.crop->corner : glm::uvec2(0);
    Picture picture{film.width, film.height, {}, {}, film.rowsAbove + corner.y, corner.x};
    for (const PixelMoments& pixel : shownPixels(film)) {
        picture.radiance.push_back(pixel.mean);
        picture.variance.push_back(computeVarianceOfMean(pixel));
    }
    return picture;
}

Picture makePicture(const Image& image, const std::string& name)
{
    Picture picture{image.width, image.height, colors(image, "", name), {}, image.rowsAbove, image.columnsLeft};
    if (image.channels.contains("variance.R")) {
        picture.variance = colors(image, "variance.", name);
        for (const char* channel : {"blocks.X", "splatBlocks.X"}) {
            if (const auto blocks = image.counts.find(channel); blocks != image.counts.end()) {
                clearUnknown(picture.variance, blocks->second);
            }
        }
    }
    return picture;
}

void setVariance(Picture& picture, const Image& image, const std::string& name)
{
    if (image.width != picture.width || image.height != picture.height) {
        throw InputError(
            MessageId::Mismatch,
            {part::file(name), ": is ", part::value(std::to_string(image.width) + "x" + std::to_string(image.height)),
             ", expected the reference's ", part::expected(std::to_string(picture.width) + "x" + std::to_string(picture.height)), "."});
    }
    picture.variance = colors(image, "", name);
    for (std::size_t i = 0; i < picture.variance.size(); ++i) {
        const glm::vec3& variance = picture.variance[i];
        if (std::fmin(variance.x, std::fmin(variance.y, variance.z)) < 0) {
            const std::string pixel = "pixel (" + std::to_string(i % picture.width) + ", " + std::to_string(i / picture.width) + ")";
            throw InputError(MessageId::OutOfRange, {part::file(name), ": ", part::place(pixel), " is ", part::value("negative"),
                                                     ", expected ", part::expected("a variance"), "."});
        }
    }
}

bool isFinite(const glm::dvec3& value) { return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z); }

}  // namespace glim
