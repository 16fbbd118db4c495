#include "host/render/film_place.hpp"

#include "host/error.hpp"
#include "host/render/film_camera.hpp"

#include <sstream>

namespace glim {
namespace {

constexpr const char *kCrop = "glim:crop", *kCamera = "glim:camera";

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

void describePlace(Image& image, const Film& film)
{
    if (!film.camera.empty()) {
        image.attributes[kCamera] = film.camera;
    }
    if (const auto worldToCamera = worldToCameraOf(film.camera)) {
        image.attributes["worldToCamera"] = *worldToCamera;
    }
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

void takePlace(const std::filesystem::path& path, const Image& image, Film& film)
{
    const auto textOf = [&image](const char* name) -> std::optional<std::string> {
        const auto found = image.attributes.find(name);
        if (found == image.attributes.end()) {
            return std::nullopt;
        }
        const std::string* text = std::get_if<std::string>(&found->second);
        return text != nullptr ? *text : "no text";
    };
    film.width = image.width;
    film.height = image.height;
    film.rowsAbove = image.rowsAbove;
    film.rowsBelow = image.rowsBelow;
    film.camera = textOf(kCamera).value_or("");
    if (!film.camera.empty() && !worldToCameraOf(film.camera)) {
        throw InputError(MessageId::Malformed, {part::file(path), ": its ", part::place("camera"), " is ", part::quoted(film.camera),
                                                ", expected ", part::expected("JSON with a pose of four rows of four numbers"), "."});
    }
    const std::optional<std::string> text = textOf(kCrop);
    if (!text) {
        return;
    }
    film.crop = parseCrop(*text);
    if (!film.crop || !agree(*film.crop, image)) {
        throw InputError(MessageId::Malformed, {part::file(path), ": its ", part::place("crop"), " is ", part::quoted(*text), ", expected ",
                                                part::expected("X,Y,W,H with all columns of its data window"), "."});
    }
    auto& [corner, size, whole] = *film.crop;
    whole = {image.columnsLeft + image.width + image.columnsRight, image.rowsAbove + image.height + image.rowsBelow};
    film.rowsAbove -= corner.y;
    film.rowsBelow -= whole.y - corner.y - size.y;
}

}  // namespace glim
