// Films as a render would make them, from random samples that are a function of (seed, pixel, block).
#pragma once

#include "host/render/film.hpp"
#include "shaders/shared/limits.h"
#include "tests/support/blocks.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

namespace glim::test {

constexpr std::uint32_t kFilmWidth = 7, kFilmHeight = 5;

inline PixelMoments simulateBlock(std::uint32_t seed, std::uint32_t pixel, std::uint32_t begin, std::uint32_t end)
{
    std::seed_seq sequence{seed, pixel, begin};
    std::mt19937 random(sequence);
    std::gamma_distribution<float> gamma(0.5F, 2.0F);
    std::normal_distribution<float> normal;
    auto draw3 = [&](auto& distribution) {
        const float x = distribution(random), y = distribution(random);
        return glm::vec3(x, y, distribution(random));
    };
    PixelMoments block{};
    block.count = end - begin;
    block.blocks = 1;
    block.mean = draw3(gamma);
    block.alpha = 1.0F / (1.0F + gamma(random));
    block.albedo = draw3(gamma);
    block.normal = draw3(normal);
    block.depth = pixel % 3 == 0 ? std::numeric_limits<float>::infinity() : gamma(random);
    block.clamped = gamma(random);
    return block;
}

// Samples [begin, end) as the renderer folds them: blocks to pages, pages to the film.
inline Film simulateFilm(std::uint32_t begin, std::uint32_t end, std::uint32_t seed = 1)
{
    Film film;
    film.width = kFilmWidth;
    film.height = kFilmHeight;
    film.pixels.assign(kFilmWidth * kFilmHeight, PixelMoments{});
    film.sampleRanges = {{begin, end}};
    film.identity = {"3f2a", "bounces=64 sampler=sobol", seed};
    film.seconds = 0.1 * (end - begin);
    film.device = "a device";
    film.sceneFile = "scenes/box.gltf";
    for (std::uint32_t first = begin; first < end;) {
        const std::uint32_t pageEnd = std::min(end, (first / kPageSamples + 1) * kPageSamples);
        std::vector<PixelMoments> page(film.pixels.size(), PixelMoments{});
        for (; first < pageEnd; first = std::min(pageEnd, blockEnd(first))) {
            const std::uint32_t last = std::min(pageEnd, blockEnd(first));
            for (std::uint32_t pixel = 0; pixel < page.size(); ++pixel) {
                page[pixel] = foldMoments(page[pixel], simulateBlock(seed, pixel, first, last));
            }
        }
        foldPage(film, 0, {page, {}, {}});
    }
    return film;
}

inline bool sameBits(const std::vector<PixelMoments>& a, const std::vector<PixelMoments>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(PixelMoments)) == 0;
}

}  // namespace glim::test
