#include "host/render/film_layers.hpp"

#include "host/error.hpp"
#include "shaders/shared/composite.h"
#include "shaders/shared/scene_types.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace fs = std::filesystem;

namespace glim {
namespace {

// Consecutive 32-bit members of moments, one letter each.
struct Layer {
    const char* prefix;
    const char* letters;
    std::size_t offset;
};

static_assert(std::is_standard_layout_v<PixelMoments> && sizeof(PixelMoments) == 17 * sizeof(float));

constexpr Layer kFloatLayers[] = {
    {"", "A", offsetof(PixelMoments, alpha)},           {"squares.", "RGB", offsetof(PixelMoments, squares)},
    {"albedo.", "RGB", offsetof(PixelMoments, albedo)}, {"normal.", "XYZ", offsetof(PixelMoments, normal)},
    {"depth.", "Z", offsetof(PixelMoments, depth)},     {"clamped.", "X", offsetof(PixelMoments, clamped)},
};
constexpr Layer kCountLayers[] = {
    {"count.", "X", offsetof(PixelMoments, count)},
    {"blocks.", "X", offsetof(PixelMoments, blocks)},
};
constexpr Layer kMeanLayers[] = {{"", "RGB", offsetof(PixelMoments, mean)}};
constexpr Layer kCameraLayers[] = {{"camera.", "RGB", offsetof(PixelMoments, mean)}};  // with splats, instead

static_assert(std::is_standard_layout_v<SplatMoments> && sizeof(SplatMoments) == 9 * sizeof(float));

constexpr Layer kSplatLayers[] = {
    {"splats.", "RGB", offsetof(SplatMoments, mean)},
    {"splatSquares.", "RGB", offsetof(SplatMoments, squares)},
    {"splatClamped.", "X", offsetof(SplatMoments, clamped)},
};
constexpr Layer kSplatCountLayers[] = {
    {"splatCount.", "X", offsetof(SplatMoments, count)},
    {"splatBlocks.", "X", offsetof(SplatMoments, blocks)},
};

static_assert(std::is_standard_layout_v<CatcherMoments> && sizeof(CatcherMoments) == 11 * sizeof(float));

constexpr Layer kCatcherLayers[] = {
    {"catcherShare.", "X", offsetof(CatcherMoments, share)},
    {"catcherWith.", "RGB", offsetof(CatcherMoments, with)},
    {"catcherWithout.", "RGB", offsetof(CatcherMoments, without)},
    {"catcherSquares.", "XYZ", offsetof(CatcherMoments, squares)},
};
constexpr Layer kCompositeLayers[] = {
    {"composite.", "RGB", offsetof(PixelMoments, mean)},
    {"composite.", "A", offsetof(PixelMoments, alpha)},
};
constexpr Layer kCatcherCountLayers[] = {{"catcherCount.", "X", offsetof(CatcherMoments, count)}};

// Calls visit(channel name, offset in the moments) for every channel of the layers.
template <class Layers, class Visit>
void forEachChannel(const Layers& layers, const std::string& prefix, Visit visit)
{
    for (const Layer& layer : layers) {
        for (std::size_t i = 0; layer.letters[i] != '\0'; ++i) {
            std::string name = prefix + layer.prefix;
            name += layer.letters[i];
            visit(name, layer.offset + i * sizeof(float));
        }
    }
}

template <class Value, class Moments>
std::vector<Value> planeOf(std::span<const Moments> pixels, std::size_t offset)
{
    std::vector<Value> plane(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        std::memcpy(&plane[i], reinterpret_cast<const std::byte*>(&pixels[i]) + offset, sizeof(Value));
    }
    return plane;
}

template <class Value, class Moments>
void takePlane(const fs::path& path, const std::map<std::string, std::vector<Value>>& planes, const std::string& name, std::size_t offset,
               std::vector<Moments>& pixels)
{
    const auto plane = planes.find(name);
    if (plane == planes.end()) {
        throw InputError(MessageId::FileDamaged,
                         {part::file(path), ": is not a complete film: it has no channel ", part::place(name), " of the expected type."});
    }
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        std::memcpy(reinterpret_cast<std::byte*>(&pixels[i]) + offset, &plane->second[i], sizeof(Value));
    }
}

// Adds the variance of the mean and, for viewing, its standard error.
void addErrors(std::span<const PixelMoments> pixels, Image& image)
{
    for (int c = 0; c < 3; ++c) {
        auto &variances = image.channels[std::string("variance.") + "RGB"[c]], &errors = image.channels[std::string("error.") + "RGB"[c]];
        variances.clear();  // of the rows before
        errors.clear();
        for (const PixelMoments& pixel : pixels) {
            variances.push_back(pixel.blocks >= 2 ? computeVarianceOfMean(pixel)[c] : std::numeric_limits<float>::infinity());
            errors.push_back(std::sqrt(variances.back()));
        }
    }
}

template <class Layers, class Moments>
void addLayers(const Layers& layers, std::span<const Moments> pixels, Image& image, const std::string& prefix = "")
{
    forEachChannel(layers, prefix,
                   [&](const std::string& name, std::size_t offset) { image.channels[name] = planeOf<float>(pixels, offset); });
}

template <class Layers, class Moments>
void addCounts(const Layers& layers, std::span<const Moments> pixels, Image& image, const std::string& prefix = "")
{
    forEachChannel(layers, prefix,
                   [&](const std::string& name, std::size_t offset) { image.counts[name] = planeOf<std::uint32_t>(pixels, offset); });
}

template <class Layers, class Moments>
void takeLayers(const fs::path& path, const Layers& layers, const Image& image, std::vector<Moments>& pixels,
                const std::string& prefix = "")
{
    forEachChannel(layers, prefix,
                   [&](const std::string& name, std::size_t offset) { takePlane(path, image.channels, name, offset, pixels); });
}

template <class Layers, class Moments>
void takeCountLayers(const fs::path& path, const Layers& layers, const Image& image, std::vector<Moments>& pixels,
                     const std::string& prefix = "")
{
    forEachChannel(layers, prefix,
                   [&](const std::string& name, std::size_t offset) { takePlane(path, image.counts, name, offset, pixels); });
}

// Calls visit(channel name, its vector among the moments of a pixel, its component) for what is known by light groups.
template <class Visit>
void forEachGroupChannel(const std::vector<std::string>& groups, const std::string& means, const std::string& products, Visit visit)
{
    const auto visitColor = [&](const std::string& layer, std::size_t at) {
        for (int c = 0; c < 3; ++c) {
            visit(layer + '.' + "RGB"[c], at, c);
        }
    };
    std::size_t pair = groups.size();
    for (std::size_t g = 0; g < groups.size(); ++g) {
        visitColor(means + groups[g], g);
        for (std::size_t other = g; other < groups.size(); ++other, ++pair) {
            visitColor(products + groups[g] + '.' + groups[other], pair);
        }
    }
}

// Layers of light groups: the mean of each, and the sums of products of each pair.
constexpr const char *kLights = "lights.", *kProducts = "lightsProducts.";
constexpr const char* kCameraLights = "cameraLights.";  // with splats, instead
constexpr const char *kSplatLights = "splatLights.", *kSplatProducts = "splatLightsProducts.";

void addGroups(const GroupMoments& moments, const std::vector<std::string>& groups, const Run& run, Image& image, const std::string& means,
               const std::string& products)
{
    if (moments.isEmpty() || moments.groups != groups.size()) {
        return;
    }
    forEachGroupChannel(groups, means, products, [&](const std::string& name, std::size_t at, int c) {
        std::vector<float>& plane = image.channels[name];
        plane.clear();
        for (std::size_t i = 0; i < run.count; ++i) {
            plane.push_back(moments.of(run.begin + i)[at][c]);
        }
    });
}

void takeGroups(const fs::path& path, const Image& image, const std::vector<std::string>& groups, GroupMoments& moments,
                const std::string& means, const std::string& products)
{
    const auto count = static_cast<std::uint32_t>(groups.size());
    if (count > kMaxLightGroups) {
        throw InputError(MessageId::OutOfRange,
                         {part::file(path), ": has ", part::value(std::to_string(count)), " ", part::place("light groups"), ", expected ",
                          part::expected("at most " + std::to_string(kMaxLightGroups)), "."});
    }
    moments = GroupMoments(count, std::size_t{image.width} * image.height);
    std::vector<float> plane(std::size_t{image.width} * image.height);
    forEachGroupChannel(groups, means, products, [&](const std::string& name, std::size_t at, int c) {
        takePlane(path, image.channels, name, 0, plane);
        for (std::size_t i = 0; i < plane.size(); ++i) {
            moments.of(i)[at][c] = plane[i];
        }
    });
}

void addSplats(const FilmMoments& moments, const std::vector<std::string>& groups, const Run& run, Image& image, const std::string& prefix)
{
    if (!moments.splats.empty()) {
        addLayers(kSplatLayers, run.of(moments.splats), image, prefix);
        addCounts(kSplatCountLayers, run.of(moments.splats), image, prefix);
        addGroups(moments.splatGroups, groups, run, image, prefix + kSplatLights, prefix + kSplatProducts);
    }
}

void addCatcher(const std::vector<CatcherMoments>& catcher, const Run& run, Image& image, const std::string& prefix)
{
    if (!catcher.empty()) {
        addLayers(kCatcherLayers, run.of(catcher), image, prefix);
        addCounts(kCatcherCountLayers, run.of(catcher), image, prefix);
    }
}

// What the film shows of each light group.
void addShownGroups(const Film& film, const std::vector<std::string>& groups, const Run& run, Image& image)
{
    for (std::size_t g = 0; g < film.groups.groups; ++g) {
        for (int c = 0; c < 3; ++c) {
            std::vector<float>& plane = image.channels[kLights + groups[g] + '.' + "RGB"[c]];
            plane.clear();
            for (std::size_t i = run.begin; i < run.begin + run.count; ++i) {
                plane.push_back(shownOfGroup(film, i, g)[c]);
            }
        }
    }
}

void takeSplats(const fs::path& path, const Image& image, const std::vector<std::string>& groups, FilmMoments& moments,
                const std::string& prefix)
{
    moments.splats.resize(std::size_t{image.width} * image.height);
    takeLayers(path, kSplatLayers, image, moments.splats, prefix);
    takeCountLayers(path, kSplatCountLayers, image, moments.splats, prefix);
    takeGroups(path, image, groups, moments.splatGroups, prefix + kSplatLights, prefix + kSplatProducts);
}

void takeCatcher(const fs::path& path, const Image& image, std::vector<CatcherMoments>& catcher, const std::string& prefix)
{
    if (image.channels.contains(prefix + "catcherWith.R")) {
        catcher.resize(std::size_t{image.width} * image.height);
        takeLayers(path, kCatcherLayers, image, catcher, prefix);
        takeCountLayers(path, kCatcherCountLayers, image, catcher, prefix);
    }
}

}  // namespace

void addFilm(const Film& film, const Run& run, bool errors, Image& image)
{
    const std::vector<std::string> groups = getLightGroups(film);
    std::vector<PixelMoments> shown(run.count), composite(film.catcher.empty() ? 0 : run.count);
    for (std::size_t i = 0; i < run.count; ++i) {
        shown[i] = shownPixel(film, run.begin + i);
    }
    addLayers(kMeanLayers, std::span<const PixelMoments>(shown), image);
    addLayers(kFloatLayers, run.of(film.pixels), image);
    addCounts(kCountLayers, run.of(film.pixels), image);
    if (film.splats.empty()) {
        addGroups(film.groups, groups, run, image, kLights, kProducts);
    } else {
        addLayers(kCameraLayers, run.of(film.pixels), image);
        addGroups(film.groups, groups, run, image, kCameraLights, kProducts);
        addShownGroups(film, groups, run, image);
        addSplats(film, groups, run, image, "");
    }
    addCatcher(film.catcher, run, image, "");
    if (!film.catcher.empty()) {
        for (std::size_t i = 0; i < run.count; ++i) {
            composite[i] = compositePixel(shown[i], film.catcher[run.begin + i]);
        }
        addLayers(kCompositeLayers, std::span<const PixelMoments>(composite), image);
    }
    if (errors) {
        addErrors(shown, image);
    }
}

void takeFilm(const fs::path& path, const Image& image, bool hasSplats, Film& film)
{
    const std::vector<std::string> groups = getLightGroups(film);
    film.pixels.resize(std::size_t{image.width} * image.height);
    takeLayers(path, kFloatLayers, image, film.pixels);
    takeCountLayers(path, kCountLayers, image, film.pixels);
    takeGroups(path, image, groups, film.groups, hasSplats ? kCameraLights : kLights, kProducts);
    if (hasSplats) {
        takeLayers(path, kCameraLayers, image, film.pixels);
        takeSplats(path, image, groups, film, "");
    } else {
        takeLayers(path, kMeanLayers, image, film.pixels);
    }
    takeCatcher(path, image, film.catcher, "");
}

void addMoments(const FilmMoments& moments, const std::vector<std::string>& lightGroups, const Run& run, Image& image,
                const std::string& prefix)
{
    if (!moments.pixels.empty()) {
        addLayers(kMeanLayers, run.of(moments.pixels), image, prefix);
        addLayers(kFloatLayers, run.of(moments.pixels), image, prefix);
        addCounts(kCountLayers, run.of(moments.pixels), image, prefix);
        addGroups(moments.groups, lightGroups, run, image, prefix + kLights, prefix + kProducts);
    }
    addSplats(moments, lightGroups, run, image, prefix);
    addCatcher(moments.catcher, run, image, prefix);
}

void takeMoments(const fs::path& path, const Image& image, const std::vector<std::string>& lightGroups, FilmMoments& moments,
                 const std::string& prefix)
{
    if (image.channels.contains(prefix + "R")) {
        moments.pixels.resize(std::size_t{image.width} * image.height);
        takeLayers(path, kMeanLayers, image, moments.pixels, prefix);
        takeLayers(path, kFloatLayers, image, moments.pixels, prefix);
        takeCountLayers(path, kCountLayers, image, moments.pixels, prefix);
        takeGroups(path, image, lightGroups, moments.groups, prefix + kLights, prefix + kProducts);
    }
    if (image.channels.contains(prefix + "splats.R")) {
        takeSplats(path, image, lightGroups, moments, prefix);
    }
    takeCatcher(path, image, moments.catcher, prefix);
}

void takeCounts(const fs::path& path, const Image& image, const std::string& channel, std::vector<std::uint32_t>& pixels)
{
    takePlane(path, image.counts, channel, 0, pixels);
}

}  // namespace glim
