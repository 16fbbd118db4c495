#include "host/render/film.hpp"

#include "host/bvh/parallel_for.hpp"
#include "host/digest.hpp"

#include <algorithm>
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
    digest.add(film.pixels);
    digest.add(film.splats);
    digest.add(film.catcher);
    return digest.finish();
}

std::string computePixelsDigest(const Film& film)
{
    Digest digest;
    digest.add(film.pixels);
    digest.add(film.splats);
    digest.add(film.catcher);
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

void foldSplats(std::vector<SplatMoments>& film, const std::vector<SplatMoments>& page)
{
    if (film.empty()) {
        film = page;
        return;
    }
    for (std::size_t i = 0; i < page.size(); ++i) {
        film[i] = foldMoments(film[i], page[i]);
    }
}

void foldCatcher(std::vector<CatcherMoments>& film, std::size_t begin, std::span<const CatcherMoments> page)
{
    if (page.empty()) {
        return;  // no film without catchers gets any
    }
    film.resize(std::max(film.size(), begin + page.size()));
    for (std::size_t i = 0; i < page.size(); ++i) {
        film[begin + i] = foldMoments(film[begin + i], page[i]);
    }
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

void foldPage(Film& film, std::size_t begin, std::span<const PixelMoments> page)
{
    constexpr std::size_t kPart = 1U << 13U;  // large enough to be worth a thread, 0.2 ms
    parallelFor((page.size() + kPart - 1) / kPart, std::thread::hardware_concurrency(), [&](std::size_t part) {
        for (std::size_t i = part * kPart; i < std::min(page.size(), (part + 1) * kPart); ++i) {
            film.pixels[begin + i] = foldMoments(film.pixels[begin + i], page[i]);
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

}  // namespace glim
