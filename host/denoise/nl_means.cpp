#include "host/denoise/nl_means.hpp"

#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/denoise_types.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace glim {
namespace {

constexpr std::uint32_t kWorkgroup = 64, kFirstPixels = 4096;
constexpr std::uint32_t kBandPixels = 1U << 21;  // 48 MiB of noisy pixels; no buffer exceeds 128 MiB, llvmpipe's limit
constexpr double kDispatchSeconds = 0.05;

// The power of two nearest below the mean radiance: dividing by it changes no bit of the result.
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
    constexpr float kMost = 1e15F;  // so that no square overflows
    const glm::vec3 mean = glm::clamp(pixel.mean / scale, -kMost, kMost);
    const glm::vec3 variance = varianceOfMean(pixel) / (scale * scale);
    NoisyPixel noisy{mean, mean * mean};
    for (int c = 0; c < 3; ++c) {
        if (std::isfinite(variance[c])) {
            noisy.variance[c] = std::min(variance[c], kMost * kMost);
        }
    }
    return noisy;
}

}  // namespace

// Rows of the picture: those that are denoised, and those that they depend on.
struct NlMeans::Band {
    std::uint32_t width, begin, end, first, last;

    std::uint32_t height() const { return last - first; }
    DenoisePass pass() const { return {width, height(), (begin - first) * width, (end - begin) * width}; }
};

NlMeans::NlMeans(Device& device)
    : device_(device),
      layout_(device, {{kBindNoisy, BufferKind::Storage}, {kBindPooled, BufferKind::Storage}, {kBindDenoised, BufferKind::Readback}},
              sizeof(DenoisePass)),
      pool_(layout_, kernels::pool_variance, {{kSpecWorkgroup, kWorkgroup}}),
      denoise_(layout_, kernels::denoise, {{kSpecWorkgroup, kWorkgroup}})
{}

bool NlMeans::run(const Kernel& kernel, const Band& band, const Bindings& bindings, const std::function<bool()>& shouldContinue)
{
    DenoisePass pass = band.pass();
    if (&kernel == &pool_) {
        pass.firstPixel = 0;
        pass.pixelCount = band.width * band.height();
    }
    std::uint32_t& most = pixels_.try_emplace(&kernel, kFirstPixels).first->second;
    const std::uint32_t end = pass.firstPixel + pass.pixelCount;
    while (pass.firstPixel < end) {
        if (!shouldContinue()) {
            return false;
        }
        pass.pixelCount = std::min(end - pass.firstPixel, most);
        const auto start = std::chrono::steady_clock::now();
        Commands commands(device_);
        commands.dispatch(kernel, bindings, std::as_bytes(std::span<const DenoisePass, 1>(&pass, 1)),
                          (pass.pixelCount + kWorkgroup - 1) / kWorkgroup);
        commands.submitAndWait();
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (pass.pixelCount == most) {
            const double wanted = most * std::clamp(kDispatchSeconds / seconds, 0.25, 2.0);
            most = std::clamp(static_cast<std::uint32_t>(wanted), kWorkgroup, device_.description().maxGroups * kWorkgroup);
        }
        pass.firstPixel += pass.pixelCount;
    }
    return true;
}

std::optional<std::vector<glm::vec3>> NlMeans::denoise(const Film& film, const std::function<bool()>& shouldContinue)
{
    const std::vector<PixelMoments> pixels = shownPixels(film);
    const float scale = scaleOf(pixels);
    constexpr std::uint32_t kMargin = kDenoiseMargin;
    const std::uint32_t rows = std::max(1U, kBandPixels / film.width);
    std::vector<glm::vec3> result;
    for (std::uint32_t begin = 0; begin < film.height; begin += rows) {
        const std::uint32_t end = std::min(film.height, begin + rows);
        const Band band{film.width, begin, end, begin > kMargin ? begin - kMargin : 0, std::min(film.height, end + kMargin)};
        std::vector<NoisyPixel> noisy;
        for (std::size_t i = std::size_t{band.first} * film.width; i < std::size_t{band.last} * film.width; ++i) {
            noisy.push_back(noisyPixel(pixels[i], scale));
        }
        Buffer noisyBuffer(device_, "noisy pixels", BufferKind::Storage, noisy.size() * sizeof(NoisyPixel));
        const Buffer pooled(device_, "pooled variance", BufferKind::Storage, noisy.size() * sizeof(glm::vec3));
        const Buffer denoised(device_, "denoised pixels", BufferKind::Readback, noisy.size() * sizeof(glm::vec3));
        upload(noisyBuffer, std::span<const NoisyPixel>(noisy));
        const Bindings bindings(layout_, {{kBindNoisy, &noisyBuffer}, {kBindPooled, &pooled}, {kBindDenoised, &denoised}});
        if (!run(pool_, band, bindings, shouldContinue) || !run(denoise_, band, bindings, shouldContinue)) {
            return std::nullopt;
        }
        const std::vector<glm::vec3> values = download<glm::vec3>(denoised, noisy.size());
        for (std::size_t i = std::size_t{begin - band.first} * film.width; i < std::size_t{end - band.first} * film.width; ++i) {
            result.push_back(values[i] * scale);
        }
    }
    return result;
}

}  // namespace glim
