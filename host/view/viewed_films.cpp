#include "host/view/viewed_films.hpp"

#include "host/error.hpp"
#include "host/image/exr.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

namespace glim {
namespace {

std::string sizeText(const Image& image) { return std::to_string(image.width) + "x" + std::to_string(image.height); }

std::filesystem::file_time_type timeOf(const std::filesystem::path& path)
{
    std::error_code failed;
    return std::filesystem::last_write_time(path, failed);
}

Image read(const std::filesystem::path& path)
{
    Image image = readExr(path);
    if (layersOf(image).empty()) {
        throw InputError(path.string() + ": has no channels.");
    }
    return image;
}

}  // namespace

ViewedFilms::ViewedFilms(const std::filesystem::path& a, const std::optional<std::filesystem::path>& b)
{
    for (const auto& path : {std::optional(a), b}) {
        if (path) {
            const auto time = timeOf(*path);
            files_.push_back({*path, time, read(*path), {}});
        }
    }
    if (b) {
        if (const auto why = disagreement(files_[0], files_[0].image, files_[1], files_[1].image)) {
            throw InputError(*why);
        }
    }
    listLayers();
}

std::optional<std::string> ViewedFilms::disagreement(const File& a, const Image& imageOfA, const File& b, const Image& imageOfB)
{
    if (imageOfA.width == imageOfB.width && imageOfA.height == imageOfB.height && imageOfA.rowsAbove == imageOfB.rowsAbove) {
        return std::nullopt;
    }
    const auto rows = [](const Image& image) {
        return image.rowsAbove > 0 ? " from row " + std::to_string(image.rowsAbove) + " on" : std::string();
    };
    return b.path.string() + ": is " + sizeText(imageOfB) + rows(imageOfB) + ", expected " + sizeText(imageOfA) + rows(imageOfA) + " as " +
           a.path.string() + ".";
}

std::string ViewedFilms::title() const
{
    std::string title = files_[0].path.filename().string();
    if (files_.size() > 1) {
        title += " and " + files_[1].path.filename().string();
    }
    return title;
}

void ViewedFilms::listLayers()
{
    layers_.clear();
    for (std::size_t i = 0; i < files_.size(); ++i) {
        for (Layer& layer : layersOf(files_[i].image)) {
            const auto found = std::find_if(layers_.begin(), layers_.end(),
                                            [&](const ViewedLayer& known) { return known.name == layer.name && !known.of[i]; });
            ViewedLayer& entry = found != layers_.end() ? *found : layers_.emplace_back(ViewedLayer{layer.name, {}});
            entry.of[i] = std::move(layer);
        }
    }
}

bool ViewedFilms::readChanged()
{
    bool any = false;
    for (File& file : files_) {
        const auto time = timeOf(file.path);
        if (time != std::filesystem::file_time_type::min() && time != file.time) {
            file.time = time;
            file.fresh = read(file.path);
            any = true;
        }
    }
    if (!any) {
        return false;
    }
    const auto latest = [](const File& file) -> const Image& { return file.fresh ? *file.fresh : file.image; };
    if (files_.size() > 1) {
        if (const auto why = disagreement(files_[0], latest(files_[0]), files_[1], latest(files_[1]))) {
            throw InputError(*why);
        }
    }
    for (File& file : files_) {
        if (file.fresh) {
            file.image = std::move(*std::exchange(file.fresh, std::nullopt));
        }
    }
    listLayers();
    return true;
}

}  // namespace glim
