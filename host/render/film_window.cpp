#include "host/render/film_window.hpp"

#include "host/error.hpp"

#include <sstream>

namespace glim {
namespace {

constexpr const char* kCrop = "glim:crop";

std::string cropText(const Crop& crop)
{
    return std::to_string(crop.corner.x) + "," + std::to_string(crop.corner.y) + "," + std::to_string(crop.size.x) + "," +
           std::to_string(crop.size.y);
}

// Four numbers that cropText writes; nothing else.
std::optional<Crop> parseCrop(const std::string& text)
{
    Crop crop;
    char between[3];
    std::istringstream words(text);
    words >> crop.corner.x >> between[0] >> crop.corner.y >> between[1] >> crop.size.x >> between[2] >> crop.size.y;
    return words && cropText(crop) == text ? std::optional(crop) : std::nullopt;
}

// Whether the image has columns of the crop, all of them, and some of its rows.
bool agree(const Crop& crop, const Image& image)
{
    const std::uint64_t above = crop.corner.y, below = above + crop.size.y;
    return image.columnsLeft == crop.corner.x && image.width == crop.size.x && image.rowsAbove >= above &&
           std::uint64_t{image.rowsAbove} + image.height <= below &&
           below <= std::uint64_t{image.rowsAbove} + image.height + image.rowsBelow;
}

}  // namespace

void setWindows(Image& image, const Film& film)
{
    image.width = film.width;
    image.height = film.height;
    image.rowsAbove = film.rowsAbove;
    image.rowsBelow = film.rowsBelow;
    if (film.crop) {
        const auto& [corner, size, whole] = *film.crop;
        image.rowsAbove += corner.y;
        image.rowsBelow += whole.y - corner.y - size.y;
        image.columnsLeft = corner.x;
        image.columnsRight = whole.x - corner.x - size.x;
        image.attributes[kCrop] = cropText(*film.crop);
    }
}

void takeWindows(const std::filesystem::path& path, const Image& image, Film& film)
{
    film.width = image.width;
    film.height = image.height;
    film.rowsAbove = image.rowsAbove;
    film.rowsBelow = image.rowsBelow;
    const auto found = image.attributes.find(kCrop);
    if (found == image.attributes.end()) {
        return;
    }
    const std::string* text = std::get_if<std::string>(&found->second);
    film.crop = text != nullptr ? parseCrop(*text) : std::nullopt;
    if (!film.crop || !agree(*film.crop, image)) {
        throw InputError(MessageId::Malformed,
                         {part::file(path), ": its ", part::place("crop"), " is ", part::quoted(text != nullptr ? *text : "a number"),
                          ", expected ", part::expected("X,Y,W,H with all columns of its data window"), "."});
    }
    auto& [corner, size, whole] = *film.crop;
    whole = {image.columnsLeft + image.width + image.columnsRight, image.rowsAbove + image.height + image.rowsBelow};
    film.rowsAbove -= corner.y;
    film.rowsBelow -= whole.y - corner.y - size.y;
}

}  // namespace glim
