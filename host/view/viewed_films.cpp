#include "host/view/viewed_films.hpp"

#include "host/error.hpp"
#include "host/image/exr.hpp"
#include "host/measure/error_estimate.hpp"
#include "host/render/film_file.hpp"
#include "host/render/film_layers.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

namespace glim {
namespace {

std::string sizeText(const Image& image) { return std::to_string(image.width) + "x" + std::to_string(image.height); }

// Of a part of a larger picture.
std::string placeText(const Image& image)
{
    const bool isPart = image.rowsAbove > 0 || image.columnsLeft > 0;
    return isPart ? " from (" + std::to_string(image.columnsLeft) + ", " + std::to_string(image.rowsAbove) + ") on" : "";
}

bool isAlike(const ViewedLayer& known, const Layer& layer)
{
    return std::any_of(known.of.begin(), known.of.end(), [&](const auto& other) { return other && other->shownAs == layer.shownAs; });
}

std::filesystem::file_time_type timeOf(const std::filesystem::path& path)
{
    std::error_code failed;
    return std::filesystem::last_write_time(path, failed);
}

Image read(const std::filesystem::path& path)
{
    Image image = readExr(path);
    if (collectLayers(image).empty()) {
        throw InputError(MessageId::Empty, {part::file(path), ": has no channels."});
    }
    return image;
}

// The film in a file, if it has light groups. A file that another program has changed is only looked at.
std::optional<Film> groupedFilm(const std::filesystem::path& path, const Image& image)
{
    try {
        if (image.attributes.contains("glim:film") && !getLightGroups(readFilmHeader(path, image)).empty()) {
            return readFilm(path, image);
        }
    } catch (const InputError&) {
        return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace

ViewedFilms::ViewedFilms(const std::filesystem::path& a, const std::optional<std::filesystem::path>& b)
{
    for (const auto& path : {std::optional(a), b}) {
        if (path) {
            const auto time = timeOf(*path);
            files_.push_back({*path, time, read(*path), {}, {}});
            files_.back().grouped = groupedFilm(*path, files_.back().image);
        }
    }
    if (b) {
        if (const auto why = disagreement(files_[0], files_[0].image, files_[1], files_[1].image)) {
            throw InputError(*why);
        }
    }
    listLayers();
}

std::optional<Message> ViewedFilms::disagreement(const File& a, const Image& imageOfA, const File& b, const Image& imageOfB)
{
    if (imageOfA.width == imageOfB.width && imageOfA.height == imageOfB.height && imageOfA.rowsAbove == imageOfB.rowsAbove &&
        imageOfA.columnsLeft == imageOfB.columnsLeft) {
        return std::nullopt;
    }
    const auto sizeOf = [](const Image& image) { return sizeText(image) + placeText(image); };
    return Message(MessageId::Mismatch, {part::file(b.path), ": is ", part::value(sizeOf(imageOfB)), ", expected ",
                                         part::expected(sizeOf(imageOfA)), ", the size of ", a.path.string(), "."});
}

std::string ViewedFilms::title() const
{
    std::string title = files_[0].path.filename().string();
    if (files_.size() > 1) {
        title += " and " + files_[1].path.filename().string();
    }
    return title;
}

std::vector<std::string> ViewedFilms::lightGroups() const
{
    return files_[0].grouped ? getLightGroups(*files_[0].grouped) : std::vector<std::string>{};
}

std::optional<double> ViewedFilms::setLights(const std::vector<glm::vec3>& factors)
{
    Image& image = files_[0].image;
    const Film film = regroup(*files_[0].grouped, factors);
    addFilm(film, {0, film.pixels.size()}, image.channels.contains("error.R"), image);
    const auto estimate = estimateError(film);
    return estimate ? std::optional(relativeRoot(estimate->errors.mse, estimate->mean)) : std::nullopt;
}

void ViewedFilms::listLayers()
{
    layers_.clear();
    for (std::size_t i = 0; i < files_.size(); ++i) {
        for (Layer& layer : collectLayers(files_[i].image)) {
            const auto found = std::find_if(layers_.begin(), layers_.end(), [&](const ViewedLayer& known) {
                return known.name == layer.name && !known.of[i] && isAlike(known, layer);
            });
            ViewedLayer& entry = found != layers_.end() ? *found : layers_.emplace_back(ViewedLayer{layer.name, {}});
            entry.of[i] = std::move(layer);
        }
    }
}

ViewedFilms::Reading ViewedFilms::readChanged()
{
    Reading reading;
    bool any = false;
    for (File& file : files_) {
        const auto time = timeOf(file.path);
        if (time == std::filesystem::file_time_type::min() || time == file.time) {
            continue;
        }
        file.time = time;
        try {
            file.fresh = read(file.path);
            any = true;
        } catch (const InputError& error) {
            reading.trouble = error.message();
        }
    }
    const auto latest = [](const File& file) -> const Image& { return file.fresh ? *file.fresh : file.image; };
    const auto why = files_.size() > 1 ? disagreement(files_[0], latest(files_[0]), files_[1], latest(files_[1])) : std::nullopt;
    if (!any || why) {
        reading.trouble = any ? why : reading.trouble;
        return reading;
    }
    for (File& file : files_) {
        if (file.fresh) {
            file.image = std::move(*std::exchange(file.fresh, std::nullopt));
            file.grouped = groupedFilm(file.path, file.image);
            reading.taken.push_back(file.path.filename().string());
        }
    }
    listLayers();
    return reading;
}

}  // namespace glim
