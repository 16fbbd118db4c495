#include "python/film.hpp"

#include "host/error.hpp"
#include "host/measure/error_estimate.hpp"
#include "host/message.hpp"
#include "host/render/composite.hpp"
#include "host/render/film_pictures.hpp"
#include "host/render/layers_file.hpp"
#include "host/render/regroup.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

namespace nb = nanobind;

namespace glim {
namespace {

// A layer of a film: a view without a copy, whose pixels are as far apart as those of the film.
template <class T>
using Layer = nb::ndarray<nb::numpy, const T>;

constexpr std::int64_t kStride = sizeof(PixelMoments) / sizeof(float);
static_assert(sizeof(PixelMoments) % sizeof(float) == 0);

template <class T>
Layer<T> layer(nb::handle owner, const T* first, std::size_t channels)
{
    const Film& film = nb::cast<const PythonFilm&>(owner).film();
    const std::size_t shape[]{film.height, film.width, channels};
    const std::int64_t strides[]{std::int64_t{film.width} * kStride, kStride, 1};
    return Layer<T>(first, channels == 1 ? 2 : 3, shape, owner, strides);
}

// An array of its own, row by row.
template <class T>
Layer<T> copied(const Film& film, std::vector<T> values, std::size_t channels)
{
    auto* kept = new std::vector<T>(std::move(values));
    const nb::capsule owner(kept, [](void* pointer) noexcept { delete static_cast<std::vector<T>*>(pointer); });
    const std::size_t shape[]{film.height, film.width, channels};
    return Layer<T>(kept->data(), channels == 1 ? 2 : 3, shape, owner);
}

template <class Member>
auto floats(Member member, std::size_t channels)
{
    return [member, channels](nb::handle self) {
        const PixelMoments& first = nb::cast<const PythonFilm&>(self).pixels().front();
        return layer<float>(self, reinterpret_cast<const float*>(&(first.*member)), channels);
    };
}

Layer<std::uint32_t> counts(nb::handle self)
{
    return layer<std::uint32_t>(self, &nb::cast<const PythonFilm&>(self).pixels().front().count, 1);
}

Layer<float> variance(const PythonFilm& film)
{
    std::vector<float> values;
    values.reserve(3 * film.pixels().size());
    for (const PixelMoments& pixel : film.pixels()) {
        const glm::vec3 of = computeVarianceOfMean(pixel);
        values.insert(values.end(), {of.r, of.g, of.b});
    }
    return copied(film.film(), std::move(values), 3);
}

// Premultiplied RGBA; None without shadow catchers.
nb::object composite(const PythonFilm& film)
{
    if (film.film().catcher.empty()) {
        return nb::none();
    }
    std::vector<float> values;
    for (const PixelMoments& pixel : pictureOf(film.film())) {
        values.insert(values.end(), {pixel.mean.r, pixel.mean.g, pixel.mean.b, pixel.alpha});
    }
    return nb::cast(copied(film.film(), std::move(values), 4));
}

// What the film shows of each light group, by name.
nb::dict lights(const PythonFilm& film)
{
    nb::dict layers;
    const std::vector<std::string> groups = getLightGroups(film.film());
    for (std::size_t g = 0; g < groups.size(); ++g) {
        std::vector<float> values;
        for (std::size_t i = 0; i < film.pixels().size(); ++i) {
            const glm::vec3 light = shownOfGroup(film.film(), i, g);
            values.insert(values.end(), {light.r, light.g, light.b});
        }
        layers[groups[g].c_str()] = copied(film.film(), std::move(values), 3);
    }
    return layers;
}

Layer<float> lightCovariance(const PythonFilm& film, std::size_t group, std::size_t other)
{
    std::vector<float> values;
    for (std::size_t i = 0; i < film.pixels().size(); ++i) {
        const glm::vec3 of = computeGroupCovariance(film.film(), i, group, other);
        values.insert(values.end(), {of.r, of.g, of.b});
    }
    return copied(film.film(), std::move(values), 3);
}

std::shared_ptr<PythonFilm> regrouped(const PythonFilm& film, const std::vector<std::pair<std::string, std::vector<float>>>& weights)
{
    std::vector<LightWeight> lights;
    for (const auto& [group, factor] : weights) {
        lights.push_back({group, {factor[0], factor[1], factor[2]}});
    }
    return std::make_shared<PythonFilm>(regroup(film.film(), factorsOf("the film", film.film(), lights)), std::nullopt);
}

nb::object ids(nb::handle self)
{
    const PythonFilm& film = nb::cast<const PythonFilm&>(self);
    if (film.ids().empty()) {
        return nb::none();
    }
    nb::dict layers;
    const std::size_t shape[]{film.film().height, film.film().width};
    for (const auto& [kind, indices] : film.ids()) {
        layers[kind.c_str()] = Layer<std::uint32_t>(indices.data(), 2, shape, self);
    }
    return layers;
}

// By name, the letters of a layer side by side.
nb::object surfaces(const PythonFilm& film)
{
    if (!film.surfaces()) {
        return nb::none();
    }
    struct SurfaceLayer {
        const char *name, *prefix, *letters;
    };
    constexpr SurfaceLayer kLayers[] = {{"position", "position.", "XYZ"},
                                        {"uv", "uv.", "UV"},
                                        {"distance", "distance.", "Y"},
                                        {"forward_flow", "forwardFlow.", "XY"},
                                        {"backward_flow", "backwardFlow.", "XY"}};
    nb::dict layers;
    for (const auto& [name, prefix, letters] : kLayers) {
        if (!film.surfaces()->channels.contains(prefix + std::string(1, letters[0]))) {
            continue;
        }
        const std::size_t count = std::strlen(letters), pixels = film.pixels().size();
        std::vector<float> values(count * pixels);
        for (std::size_t k = 0; k < count; ++k) {
            const std::vector<float>& channel = film.surfaces()->channels.at(prefix + std::string(1, letters[k]));
            for (std::size_t i = 0; i < pixels; ++i) {
                values[count * i + k] = channel[i];
            }
        }
        layers[name] = copied(film.film(), std::move(values), count);
    }
    layers["instance"] = copied(film.film(), film.surfaces()->counts.at("instance.X"), 1);
    return layers;
}

// The estimate's figures in the order of glim.Error; None if the film does not know its error.
nb::object estimate(const PythonFilm& film)
{
    const auto known = estimateError(film.film());
    if (!known) {
        return nb::none();
    }
    const auto root = [&](double meanSquare) { return relativeRoot(meanSquare, known->mean); };
    return nb::make_tuple(root(known->errors.mse), root(known->mse.low), root(known->mse.high), known->errors.relMse, known->relMse.low,
                          known->relMse.high, known->errors.mse, known->mean, known->isOfFew());
}

// At most `most` pixels wide: each pixel is the mean of a square block. The last blocks take what is left over at the right and below.
Film shrunk(const Film& film, std::uint32_t most)
{
    const std::uint32_t side = (film.width + most - 1) / most;
    Film small;
    small.width = std::max(1U, film.width / side);
    small.height = std::max(1U, film.height / side);
    small.identity = film.identity;
    small.showsBackground = film.showsBackground;
    small.pixels.resize(std::size_t{small.width} * small.height);
    std::vector<std::uint32_t> counts(small.pixels.size());
    const std::vector<PixelMoments> pixels = pictureOf(film);
    for (std::uint32_t y = 0; y < film.height; ++y) {
        for (std::uint32_t x = 0; x < film.width; ++x) {
            const PixelMoments& pixel = pixels[std::size_t{y} * film.width + x];
            const std::size_t to = std::size_t{std::min(y / side, small.height - 1)} * small.width + std::min(x / side, small.width - 1);
            const float share = 1.0F / static_cast<float>(++counts[to]);
            PixelMoments& mean = small.pixels[to];
            mean.count = std::max(mean.count, pixel.count);
            mean.mean += (pixel.mean - mean.mean) * share;
            mean.alpha += (pixel.alpha - mean.alpha) * share;
            mean.albedo += (pixel.albedo - mean.albedo) * share;
            mean.normal += (pixel.normal - mean.normal) * share;
            mean.depth = counts[to] == 1 ? pixel.depth : std::min(mean.depth, pixel.depth);
        }
    }
    return small;
}

void saveExr(const PythonFilm& film, const std::filesystem::path& path)
{
    if (const auto& denoising = film.denoising()) {
        const DenoisedLayers layers = layersOf(*denoising);
        writeFilm(path, film.film(), {.denoised = &layers});
    } else {
        writeFilm(path, film.film());
    }
}

Film shownFilm(const PythonFilm& film)
{
    return film.denoising() ? showDenoised(film.film(), film.denoising()->picture.radiance) : film.film();
}

void savePicture(const PythonFilm& film, const std::filesystem::path& path, std::optional<double> exposure, const std::string& tone,
                 std::optional<std::uint32_t> width)
{
    const Film shown = shownFilm(film);
    const Aov aov = getAov(shown);
    Look look{exposure ? *exposure : chooseExposure(shown, aov), Tone::None};
    for (const Tone known : {Tone::Neutral, Tone::Agx}) {
        look.tone = tone == getName(known) ? known : look.tone;
    }
    if (tone != getName(look.tone)) {
        throw InputError(MessageId::UnknownName,
                         {part::place("tone"), ": ", part::quoted(tone), ": expected ", part::expected("none, neutral or agx"), "."});
    }
    writeFilmPicture(path, width && *width < shown.width ? shrunk(shown, *width) : shown, aov, look);
}

// None unless the film was denoised.
nb::object denoised(const PythonFilm& film)
{
    if (!film.denoising()) {
        return nb::none();
    }
    std::vector<float> values;
    for (const glm::vec3& radiance : film.denoising()->picture.radiance) {
        values.insert(values.end(), {radiance.r, radiance.g, radiance.b});
    }
    return nb::cast(copied(film.film(), std::move(values), 3));
}

// As estimate(), of the denoised picture.
nb::object measured(const PythonFilm& film)
{
    if (!film.denoising()) {
        return nb::none();
    }
    const DenoisedError& known = film.denoising()->picture.measured;
    if (!known.isKnown()) {
        return nb::none();
    }
    const auto root = [&](double meanSquare) { return relativeRoot(meanSquare, known.mean); };
    return nb::make_tuple(root(known.mse.value), root(known.mse.low), root(known.mse.high), known.relMse, nb::none(), nb::none(),
                          known.mse.value, known.mean, false);
}

}  // namespace

PythonFilm::PythonFilm(Film film, std::optional<Checkpoint> checkpoint)
    : film_(std::move(film)),
      checkpoint_(std::move(checkpoint))
{
    if (!film_.splats.empty()) {
        shown_ = shownPixels(film_);
    }
}

void PythonFilm::identify(Identifier& identifier)
{
    const Image image = identifier.rows(film_, 0, film_.height);
    for (const char* kind : {"node", "mesh", "material"}) {
        ids_[kind] = image.counts.at(std::string(kind) + ".X");
    }
}

void bindFilm(nb::module_& module)
{
    constexpr auto own = nb::rv_policy::reference;  // an array names its owner itself
    nb::class_<PythonFilm>(module, "Film")
        .def_prop_ro("width", [](const PythonFilm& film) { return film.film().width; })
        .def_prop_ro("height", [](const PythonFilm& film) { return film.film().height; })
        .def_prop_ro("samples", [](const PythonFilm& film) { return film.film().sampleRanges; })
        .def_prop_ro("complete", [](const PythonFilm& film) { return film.film().complete; })
        .def_prop_ro("seconds", [](const PythonFilm& film) { return film.film().seconds; })
        .def_prop_ro("device", [](const PythonFilm& film) { return film.film().device; })
        .def_prop_ro("camera", [](const PythonFilm& film) { return film.film().camera; })
        .def_prop_ro("settings", [](const PythonFilm& film) { return film.film().identity.settings; })
        .def_prop_ro("digest", [](const PythonFilm& film) { return computeDigest(film.film()); })
        .def_prop_ro("pixels_digest", [](const PythonFilm& film) { return computePixelsDigest(film.film()); })
        .def_prop_ro("rgb", floats(&PixelMoments::mean, 3), own)
        .def_prop_ro("alpha", floats(&PixelMoments::alpha, 1), own)
        .def_prop_ro("albedo", floats(&PixelMoments::albedo, 3), own)
        .def_prop_ro("normal", floats(&PixelMoments::normal, 3), own)
        .def_prop_ro("depth", floats(&PixelMoments::depth, 1), own)
        .def_prop_ro("count", &counts, own)
        .def_prop_ro("variance", &variance, own)
        .def_prop_ro("composite", &composite)
        .def_prop_ro("alpha_rmse", [](const PythonFilm& film) { return computeAlphaRmse(film.film()); })
        .def_prop_ro("light_groups", [](const PythonFilm& film) { return getLightGroups(film.film()); })
        .def_prop_ro("lights", &lights)
        .def("light_covariance", &lightCovariance)
        .def("regroup", &regrouped)
        .def_prop_ro("ids", &ids)
        .def_prop_ro("surfaces", &surfaces)
        .def_prop_ro("objects", &PythonFilm::objects)
        .def_prop_ro("estimate", &estimate)
        .def_prop_ro("denoised", &denoised)
        .def_prop_ro("measured", &measured)
        .def("save", &saveExr)
        .def("save_layers", [](const PythonFilm& film, const std::filesystem::path& path) { writeLayers(path, shownFilm(film)); })
        .def("save_picture", &savePicture, nb::arg("path"), nb::arg("exposure").none(), nb::arg("tone"), nb::arg("width").none());
    module.def(
        "read",
        [](const std::filesystem::path& path) {
            StoredFilm stored = readStoredFilm(path);
            return std::make_shared<PythonFilm>(std::move(stored.film), std::move(stored.checkpoint));
        },
        nb::arg("path"));
}

}  // namespace glim
