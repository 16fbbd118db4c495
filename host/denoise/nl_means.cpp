#include "host/denoise/nl_means.hpp"

#include "host/clock.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

constexpr std::uint32_t kWorkgroup = 64, kFirstThreads = 4096;
constexpr std::uint32_t kBandPixels = 1U << 21;  // 88 MiB of distances; no buffer exceeds 128 MiB, Vulkan's least limit
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

// Rows of the picture: those that are denoised, and those that they depend on, with their buffers.
struct NlMeans::Work::Band {
    std::uint32_t begin, end, first, last;
    Buffer given, pooled, distances, sums;
    Bindings bindings;

    std::uint32_t height() const { return last - first; }
};

NlMeans::NlMeans(Device& device)
    : device_(device),
      layout_(device,
              {{kBindNoisy, BufferKind::Storage},
               {kBindPooled, BufferKind::Storage},
               {kBindDistances, BufferKind::Storage},
               {kBindSums, BufferKind::Storage}},
              sizeof(DenoisePass)),
      pool_(layout_, kernels::pool_variance, {{kSpecWorkgroup, kWorkgroup}}),
      compare_(layout_, kernels::compare_pixels, {{kSpecWorkgroup, kWorkgroup}}),
      weigh_(layout_, kernels::weigh_patches, {{kSpecWorkgroup, kWorkgroup}})
{}

NlMeans::Work::Work(NlMeans& denoiser, const Film& film)
    : denoiser_(denoiser),
      width_(film.width),
      height_(film.height)
{
    const std::vector<PixelMoments> pixels = shownPixels(film);
    scale_ = scaleOf(pixels);
    for (const PixelMoments& pixel : pixels) {
        noisy_.push_back(noisyPixel(pixel, scale_));
    }
}

void NlMeans::Work::openBand()
{
    constexpr std::uint32_t kMargin = kDenoiseMargin;
    const std::uint32_t rows = kBandPixels / width_ - 2 * kMargin;  // a picture is at most 65,535 pixels wide
    const auto begin = static_cast<std::uint32_t>(result_.size() / width_), end = std::min(height_, begin + rows);
    const std::uint32_t first = begin > kMargin ? begin - kMargin : 0, last = std::min(height_, end + kMargin);
    const std::size_t count = std::size_t{last - first} * width_;
    Device& device = denoiser_.device_;
    Buffer given(device, "noisy pixels", BufferKind::Storage, count * sizeof(NoisyPixel));
    Buffer pooled(device, "pooled variance", BufferKind::Storage, count * sizeof(glm::vec3));
    Buffer distances(device, "distances of pixels", BufferKind::Storage, count * kWindowWidth * sizeof(float));
    Buffer sums(device, "sums over windows", BufferKind::Storage, count * sizeof(WeightedSum));
    upload(given, std::span<const NoisyPixel>(noisy_).subspan(std::size_t{first} * width_, count));
    Commands commands(device);
    commands.fillWithZero(sums);
    commands.submitAndWait();
    Bindings bindings(denoiser_.layout_, {{kBindNoisy, &given}, {kBindPooled, &pooled}, {kBindDistances, &distances}, {kBindSums, &sums}});
    band_ = std::make_shared<Band>(
        Band{begin, end, first, last, std::move(given), std::move(pooled), std::move(distances), std::move(sums), std::move(bindings)});
    step_ = thread_ = 0;
}

// In dispatches of about a twentieth of a second.
bool NlMeans::Work::runStep(const std::function<bool()>& shouldContinue)
{
    const Kernel& kernel = step_ == 0 ? denoiser_.pool_ : step_ % 2 == 1 ? denoiser_.compare_ : denoiser_.weigh_;
    const std::uint32_t rows = band_->height(), strips = (rows + kStripRows - 1) / kStripRows;
    const std::uint32_t count = width_ * (&kernel == &denoiser_.weigh_ ? strips : rows);
    std::uint32_t& most = denoiser_.threads_.try_emplace(&kernel, kFirstThreads).first->second;
    DenoisePass pass{width_, rows};
    pass.windowRow = step_ == 0 ? 0 : (step_ - 1) / 2;
    for (; thread_ < count; thread_ += pass.count) {
        if (!shouldContinue()) {
            return false;
        }
        pass.first = thread_;
        pass.count = std::min(count - thread_, most);
        const auto start = Clock::now();
        Commands commands(denoiser_.device_);
        commands.dispatch(kernel, band_->bindings, std::as_bytes(std::span<const DenoisePass, 1>(&pass, 1)),
                          (pass.count + kWorkgroup - 1) / kWorkgroup);
        commands.submitAndWait();
        const double seconds = secondsSince(start);
        if (pass.count == most) {
            const double wanted = most * std::clamp(kDispatchSeconds / seconds, 0.25, 2.0);
            const double allowed = std::min(0x1p31, static_cast<double>(denoiser_.device_.description().maxGroups) * kWorkgroup);
            most = static_cast<std::uint32_t>(std::clamp(wanted, double{kWorkgroup}, allowed));
        }
    }
    thread_ = 0;
    return true;
}

void NlMeans::Work::closeBand()
{
    const std::vector<WeightedSum> sums = download<WeightedSum>(band_->sums, std::size_t{band_->height()} * width_);
    const std::size_t above = std::size_t{band_->begin - band_->first} * width_, count = std::size_t{band_->end - band_->begin} * width_;
    for (std::size_t i = above; i < above + count; ++i) {
        result_.push_back(sums[i].radiance / sums[i].weight * scale_);
    }
    band_.reset();
}

bool NlMeans::Work::advance(const std::function<bool()>& shouldContinue)
{
    while (result_.size() < noisy_.size()) {
        if (!band_) {
            openBand();
        }
        for (; step_ <= 2 * kWindowWidth; ++step_) {
            if (!runStep(shouldContinue)) {
                return false;
            }
        }
        closeBand();
    }
    return true;
}

std::optional<std::vector<glm::vec3>> NlMeans::denoise(const Film& film, const std::function<bool()>& shouldContinue)
{
    Work work(*this, film);
    return work.advance(shouldContinue) ? std::optional(work.takeResult()) : std::nullopt;
}

}  // namespace glim
