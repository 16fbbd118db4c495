#include "host/denoise/nl_means.hpp"

#include "host/clock.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

constexpr std::uint32_t kWorkgroup = 64, kFirstThreads = 4096;
constexpr std::uint32_t kBandPixels = 1U << 21;  // 88 MiB of distances; no buffer exceeds 128 MiB, llvmpipe's limit
constexpr double kDispatchSeconds = 0.05;

// The power of two nearest below the mean radiance: dividing by it changes no bit of the result. Squares of what is divided are normal
// numbers; a mean radiance below 1e-30 W/(sr m^2) counts as black.
float scaleOf(const std::vector<PixelMoments>& pixels)
{
    double sum = 0.0;
    for (const PixelMoments& pixel : pixels) {
        sum += static_cast<double>(pixel.mean.r) + static_cast<double>(pixel.mean.g) + static_cast<double>(pixel.mean.b);
    }
    const double mean = sum / (3.0 * static_cast<double>(pixels.size()));
    return std::isfinite(mean) && mean > 1e-30 ? static_cast<float>(std::exp2(std::clamp(std::floor(std::log2(mean)), -60.0, 60.0))) : 1.0F;
}

// Where the variance is unknown, the pixel itself stands for its standard error.
NoisyPixel noisyPixel(const PixelMoments& pixel, float scale)
{
    constexpr float kMax = 1e15F;  // so that no square overflows
    const glm::vec3 mean = glm::clamp(pixel.mean / scale, -kMax, kMax);
    const glm::vec3 variance = computeVarianceOfMean(pixel) / (scale * scale);
    NoisyPixel noisy{mean, mean * mean};
    for (int c = 0; c < 3; ++c) {
        if (std::isfinite(variance[c])) {
            noisy.variance[c] = std::min(variance[c], kMax * kMax);
        }
    }
    return noisy;
}

}  // namespace

// Rows of the picture: those that are denoised, and those that they depend on.
struct NlMeans::Band {
    std::uint32_t width, begin, end, first, last;

    std::uint32_t height() const { return last - first; }
};

NlMeans::NlMeans(Device& device)
    : device_(device),
      layout_(device,
              {{kBindNoisy, BufferKind::Storage},
               {kBindPooled, BufferKind::Storage},
               {kBindDistances, BufferKind::Storage},
               {kBindSums, BufferKind::Readback}},
              sizeof(DenoisePass)),
      pool_(layout_, kernels::pool_variance, {{kSpecWorkgroup, kWorkgroup}}),
      compare_(layout_, kernels::compare_pixels, {{kSpecWorkgroup, kWorkgroup}}),
      weigh_(layout_, kernels::weigh_patches, {{kSpecWorkgroup, kWorkgroup}})
{}

bool NlMeans::run(const Kernel& kernel, const Bindings& bindings, DenoisePass pass, std::uint32_t count,
                  const std::function<bool()>& shouldContinue)
{
    std::uint32_t& most = threads_.try_emplace(&kernel, kFirstThreads).first->second;
    for (pass.first = 0; pass.first < count; pass.first += pass.count) {
        if (!shouldContinue()) {
            return false;
        }
        pass.count = std::min(count - pass.first, most);
        const auto start = Clock::now();
        Commands commands(device_);
        commands.dispatch(kernel, bindings, std::as_bytes(std::span<const DenoisePass, 1>(&pass, 1)),
                          (pass.count + kWorkgroup - 1) / kWorkgroup);
        commands.submitAndWait();
        const double seconds = secondsSince(start);
        if (pass.count == most) {
            const double wanted = most * std::clamp(kDispatchSeconds / seconds, 0.25, 2.0);
            most = std::clamp(static_cast<std::uint32_t>(wanted), kWorkgroup, device_.description().maxGroups * kWorkgroup);
        }
    }
    return true;
}

// For each pixel of the band the weighted sum over its window.
std::optional<std::vector<WeightedSum>> NlMeans::sumWindows(const Band& band, const std::vector<NoisyPixel>& noisy,
                                                            const std::function<bool()>& shouldContinue)
{
    Buffer given(device_, "noisy pixels", BufferKind::Storage, noisy.size() * sizeof(NoisyPixel));
    const Buffer pooled(device_, "pooled variance", BufferKind::Storage, noisy.size() * sizeof(glm::vec3));
    const Buffer distances(device_, "distances of pixels", BufferKind::Storage, noisy.size() * kWindowWidth * sizeof(float));
    const Buffer sums(device_, "sums over windows", BufferKind::Readback, noisy.size() * sizeof(WeightedSum));
    upload(given, std::span<const NoisyPixel>(noisy));
    Commands commands(device_);
    commands.fillWithZero(sums);
    commands.submitAndWait();
    const Bindings bindings(layout_, {{kBindNoisy, &given}, {kBindPooled, &pooled}, {kBindDistances, &distances}, {kBindSums, &sums}});
    const auto pixels = static_cast<std::uint32_t>(noisy.size());
    const std::uint32_t strips = band.width * ((band.height() + kStripRows - 1) / kStripRows);
    DenoisePass pass{band.width, band.height()};
    bool goesOn = run(pool_, bindings, pass, pixels, shouldContinue);
    for (; pass.windowRow < kWindowWidth && goesOn; ++pass.windowRow) {
        goesOn = run(compare_, bindings, pass, pixels, shouldContinue) && run(weigh_, bindings, pass, strips, shouldContinue);
    }
    return goesOn ? std::optional(download<WeightedSum>(sums, noisy.size())) : std::nullopt;
}

std::optional<std::vector<glm::vec3>> NlMeans::denoise(const Film& film, const std::function<bool()>& shouldContinue)
{
    const std::vector<PixelMoments> pixels = shownPixels(film);
    const float scale = scaleOf(pixels);
    constexpr std::uint32_t kMargin = kDenoiseMargin;
    const std::uint32_t rows = kBandPixels / film.width - 2 * kMargin;  // a picture is at most 65,535 pixels wide
    std::vector<glm::vec3> result;
    for (std::uint32_t begin = 0; begin < film.height; begin += rows) {
        const std::uint32_t end = std::min(film.height, begin + rows);
        const Band band{film.width, begin, end, begin > kMargin ? begin - kMargin : 0, std::min(film.height, end + kMargin)};
        std::vector<NoisyPixel> noisy;
        for (std::size_t i = std::size_t{band.first} * film.width; i < std::size_t{band.last} * film.width; ++i) {
            noisy.push_back(noisyPixel(pixels[i], scale));
        }
        const auto sums = sumWindows(band, noisy, shouldContinue);
        if (!sums) {
            return std::nullopt;
        }
        for (std::size_t i = std::size_t{begin - band.first} * film.width; i < std::size_t{end - band.first} * film.width; ++i) {
            result.push_back((*sums)[i].radiance / (*sums)[i].weight * scale);
        }
    }
    return result;
}

}  // namespace glim
