#include "host/render/film.hpp"

#include "host/bvh/parallel_for.hpp"
#include "host/digest.hpp"
#include "host/render/settings.hpp"
#include "shaders/shared/scene_types.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <thread>

namespace glim {
namespace {

// Blocks whose means have the spread of the sum of two independent means. Welch, "The Generalization of 'Student's' Problem when Several
// Different Population Variances are Involved", 1947.
std::uint32_t jointBlocks(double varianceA, std::uint32_t blocksA, double varianceB, std::uint32_t blocksB)
{
    constexpr double kMax = 4294967294.0;  // a file may claim any number of blocks
    const double least = std::min(blocksA, blocksB) - 1.0, most = std::min(static_cast<double>(blocksA) + blocksB - 2.0, kMax);
    const double spread = varianceA * varianceA / (blocksA - 1.0) + varianceB * varianceB / (blocksB - 1.0);
    const double sum = varianceA + varianceB, degrees = sum * sum / spread;
    return 1 + static_cast<std::uint32_t>(std::lround(std::isfinite(degrees) ? std::clamp(degrees, least, most) : least));
}

void addMoments(const FilmMoments& film, Digest& digest)
{
    digest.add(film.pixels);
    digest.add(film.splats);
    digest.add(film.catcher);
    digest.add(film.groups.values);
    digest.add(film.splatGroups.values);
}

}  // namespace

std::string computeDigest(const Film& film)
{
    Digest digest;
    for (const std::string& text : {film.identity.scene, film.identity.settings, film.identity.kernels, film.arithmetic}) {
        digest.add(text);
    }
    digest.add(std::vector<std::uint32_t>{film.identity.seed, film.width, film.height, film.complete ? 1U : 0U});
    if (film.rowsAbove > 0 || film.rowsBelow > 0) {
        digest.add(std::vector<std::uint32_t>{film.rowsAbove, film.rowsBelow});
    }
    for (const auto& [begin, end] : film.sampleRanges) {
        digest.add(std::vector<std::uint32_t>{begin, end});
    }
    addMoments(film, digest);
    return digest.finish();
}

std::string computePixelsDigest(const Film& film)
{
    Digest digest;
    addMoments(film, digest);
    return digest.finish();
}

PixelMoments widened(const SplatMoments& splat)
{
    PixelMoments pixel{};
    pixel.count = splat.count;
    pixel.blocks = splat.blocks;
    pixel.mean = splat.mean;
    pixel.squares = splat.squares;
    pixel.clamped = splat.clamped;
    return pixel;
}

SplatMoments narrowed(const PixelMoments& pixel) { return {pixel.count, pixel.blocks, pixel.mean, pixel.squares, pixel.clamped}; }

SplatMoments foldMoments(const SplatMoments& a, const SplatMoments& b) { return narrowed(foldMoments(widened(a), widened(b))); }

void foldGroups(std::span<glm::vec3> film, std::uint32_t filmSamples, std::span<const glm::vec3> page, std::uint32_t pageSamples,
                std::uint32_t groups)
{
    if (pageSamples == 0) {
        return;
    }
    if (filmSamples == 0) {
        std::ranges::copy(page, film.begin());
        return;
    }
    const auto before = static_cast<float>(filmSamples);
    const float share = static_cast<float>(pageSamples) / static_cast<float>(filmSamples + pageSamples);
    std::array<glm::vec3, kMaxLightGroups> deltas;
    for (std::uint32_t g = 0; g < groups; ++g) {
        deltas[g] = page[g] - film[g];
        film[g] = foldMean(film[g], deltas[g], share);
    }
    std::size_t pair = groups;
    for (std::uint32_t g = 0; g < groups; ++g) {
        for (std::uint32_t other = g; other < groups; ++other, ++pair) {
            film[pair] = foldProducts(film[pair], page[pair], deltas[g], deltas[other], before, share);
        }
    }
}

void foldSplats(FilmMoments& film, const FilmMoments& page)
{
    if (film.splats.empty()) {
        film.splats = page.splats;
        film.splatGroups = page.splatGroups;
        return;
    }
    for (std::size_t i = 0; i < page.splatGroups.pixelCount(); ++i) {
        foldGroups(film.splatGroups.of(i), film.splats[i].count, page.splatGroups.of(i), page.splats[i].count, page.splatGroups.groups);
    }
    for (std::size_t i = 0; i < page.splats.size(); ++i) {
        film.splats[i] = foldMoments(film.splats[i], page.splats[i]);
    }
}

void foldMoments(FilmMoments& film, const FilmMoments& page)
{
    foldPage(film, 0, {page.pixels, page.catcher, page.groups.values});
    foldSplats(film, page);
}

std::vector<std::string> getLightGroups(const Film& film)
{
    std::istringstream text(findSetting(film.identity.settings, "light-groups"));
    std::vector<std::string> names;
    for (std::string name; std::getline(text, name, ',');) {
        names.push_back(name);
    }
    return names;
}

bool hasOneArithmetic(const Film& film) { return film.arithmetic.find(' ') == std::string::npos; }

void addArithmetic(Film& film, const std::string& arithmetic)
{
    std::istringstream words(arithmetic);
    for (std::string word; words >> word;) {
        if (film.arithmetic.find(word) == std::string::npos) {
            film.arithmetic += (film.arithmetic.empty() ? "" : " ") + word;
        }
    }
}

void foldPage(FilmMoments& film, std::size_t begin, const PageView& page)
{
    constexpr std::size_t kPart = 1U << 13U;  // large enough to be worth a thread, 0.2 ms
    if (!page.catcher.empty()) {
        film.catcher.resize(std::max(film.catcher.size(), begin + page.catcher.size()));  // of a damaged file
    }
    const std::size_t moments = page.groups.empty() ? 0 : momentsOfGroups(film.groups.groups);
    parallelFor((page.pixels.size() + kPart - 1) / kPart, std::thread::hardware_concurrency(), [&](std::size_t part) {
        for (std::size_t i = part * kPart; i < std::min(page.pixels.size(), (part + 1) * kPart); ++i) {
            PixelMoments& pixel = film.pixels[begin + i];
            if (moments > 0) {
                foldGroups(film.groups.of(begin + i), pixel.count, page.groups.subspan(i * moments, moments), page.pixels[i].count,
                           film.groups.groups);
            }
            if (!page.catcher.empty()) {
                film.catcher[begin + i] = foldMoments(film.catcher[begin + i], page.catcher[i]);
            }
            pixel = foldMoments(pixel, page.pixels[i]);
        }
    });
}

glm::vec3 computeVarianceOfMean(const PixelMoments& moments)
{
    if (moments.blocks < 2) {
        return glm::vec3(std::numeric_limits<float>::quiet_NaN());
    }
    return moments.squares / (static_cast<float>(moments.blocks - 1) * static_cast<float>(moments.count));
}

PixelMoments shownPixel(const Film& film, std::size_t i)
{
    PixelMoments pixel = film.pixels[i];
    if (film.splats.empty() || pixel.count == 0) {
        return pixel;
    }
    const SplatMoments& splat = film.splats[i];
    pixel.mean += splat.mean;
    pixel.clamped += splat.clamped;
    if (pixel.blocks < 2 || splat.blocks < 2) {
        pixel.blocks = std::min(pixel.blocks, splat.blocks);
        return pixel;
    }
    const glm::vec3 a = computeVarianceOfMean(film.pixels[i]), b = computeVarianceOfMean(widened(splat)), sum = a + b;
    pixel.blocks = jointBlocks(static_cast<double>(a.r + a.g + a.b), pixel.blocks, static_cast<double>(b.r + b.g + b.b), splat.blocks);
    pixel.squares = sum * (static_cast<float>(pixel.blocks - 1) * static_cast<float>(pixel.count));
    return pixel;
}

std::vector<PixelMoments> shownPixels(const Film& film)
{
    std::vector<PixelMoments> pixels = film.pixels;
    for (std::size_t i = 0; i < film.splats.size(); ++i) {
        pixels[i] = shownPixel(film, i);
    }
    return pixels;
}

glm::vec3 shownOfGroup(const Film& film, std::size_t pixel, std::size_t group)
{
    const glm::vec3 camera = film.groups.of(pixel)[group];
    return film.splatGroups.isEmpty() ? camera : camera + film.splatGroups.of(pixel)[group];
}

glm::vec3 computeGroupCovariance(const Film& film, std::size_t pixel, std::size_t group, std::size_t other)
{
    const std::size_t first = std::min(group, other), second = std::max(group, other), groups = film.groups.groups;
    const std::size_t pair = groups + first * groups - first * (first + 1) / 2 + second;
    PixelMoments camera = film.pixels[pixel];
    camera.squares = film.groups.of(pixel)[pair];
    glm::vec3 covariance = computeVarianceOfMean(camera);
    if (!film.splatGroups.isEmpty()) {
        PixelMoments light = widened(film.splats[pixel]);
        light.squares = film.splatGroups.of(pixel)[pair];
        covariance += computeVarianceOfMean(light);
    }
    return covariance;
}

}  // namespace glim
