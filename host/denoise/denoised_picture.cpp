#include "host/denoise/denoised_picture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glim {
namespace {

constexpr std::uint32_t kTile = 16;  // pixels a side

// Two halves A and B of the samples, denoised to a and b, each without a look at the other half. With the truth t, the errors a - t and
// A - t are independent of b - t and B - t, and the means of A - t and B - t are 0. The squared error of the picture (a + b) / 2 is
//   ((a - t) + (b - t))^2 / 4 = (a - b)^2 / 4 + (a - t) (b - t),
// and the last product has the mean of (A - a) (B - b) = ((A - t) - (a - t)) ((B - t) - (b - t)), whose other three terms have the mean 0.
// Nothing is assumed of the denoiser or of the noise.
struct PixelError {
    double spread = 0.0;   // (a - b)^2 / 4
    double product = 0.0;  // (A - a) (B - b)
    double excess = 0.0;   // ((A - a)^2 - (B - b)^2) / 2
    double balance = 0.0;  // of the halves' variances v and w: 4 v w / (v + w)^2

    double square() const { return spread + product; }
};

// Whether the sum is above 0 by more than chance gives. A tile is judged by the samples that its error is measured by. At three standard
// errors that hardly flatters: one tile in 700 whose denoising neither helps nor hurts is taken for worse.
class Verdict {
public:
    void add(double value)
    {
        sum_ += value;
        squares_ += value * value;
    }
    bool isWorse() const { return sum_ > 3.0 * std::sqrt(squares_); }

private:
    double sum_ = 0.0, squares_ = 0.0;
};

// Calls visit(pixels) for each tile, row by row.
template <class Visit>
void forEachTile(const glm::uvec2& size, Visit visit)
{
    for (std::uint32_t y = 0; y < size.y; y += kTile) {
        for (std::uint32_t x = 0; x < size.x; x += kTile) {
            std::vector<std::size_t> pixels;
            for (std::uint32_t j = y; j < std::min(y + kTile, size.y); ++j) {
                for (std::uint32_t i = x; i < std::min(x + kTile, size.x); ++i) {
                    pixels.push_back(std::size_t{j} * size.x + i);
                }
            }
            visit(pixels);
        }
    }
}

// The mean error with a 95 % interval for the true one. They differ by (A - a) (B - b) - (a - t) (b - t) in every pixel.
// - Without bias the square of the first product is its variance; with bias it is more. The square of `excess` is its variance whatever
//   the bias is, but more if the noise has long tails or the halves are unlike. The smaller sum is taken.
// - The second product is not seen. Its variance is v w, with the variances v of a - t and w of b - t, and 16 spread^2 = (a - b)^4 has the
//   mean 3 (v + w)^2.
// The moments are those of normal noise that all channels of a pixel have alike (Isserlis 1918). Sums over tiles would know that
// neighbours share noise, but take errors that differ from place to place for noise: twice too wide an interval. What neighbours share is
// small against the noise that was taken away, which is in the first product and not shared. Errors are positive, so the interval is that
// of the logarithm.
Interval intervalOf(const std::vector<PixelError>& errors)
{
    const auto count = static_cast<double>(errors.size());
    double sum = 0.0, products = 0.0, excesses = 0.0, spreads = 0.0;
    for (const PixelError& error : errors) {
        sum += error.square();
        products += error.product * error.product;
        excesses += error.excess * error.excess;
        spreads += error.balance * error.spread * error.spread;
    }
    const double variance = std::min(products, excesses) + 4.0 / 3.0 * spreads;
    const double mean = sum / count, halfWidth = twoSidedLimit(0.05) * std::sqrt(variance) / count;
    return mean > 0.0 ? Interval{mean, mean / std::exp(halfWidth / mean), mean * std::exp(halfWidth / mean)}
                      : Interval{mean, 0.0, mean + halfWidth};
}

// Means over the squares of 17 pixels around each pixel.
std::vector<glm::dvec3> averageAround(const glm::uvec2& size, const std::vector<glm::dvec3>& values)
{
    constexpr int kRadius = 8;
    const int width = static_cast<int>(size.x), height = static_cast<int>(size.y);
    const auto along = [&](const std::vector<glm::dvec3>& from, int length, int step, int lines, int lineStep) {
        std::vector<glm::dvec3> to(from.size());
        for (int line = 0; line < lines; ++line) {
            for (int i = 0; i < length; ++i) {
                const int begin = std::max(0, i - kRadius), end = std::min(length, i + kRadius + 1);
                glm::dvec3 sum(0.0);
                for (int j = begin; j < end; ++j) {
                    sum += from[static_cast<std::size_t>(line * lineStep + j * step)];
                }
                to[static_cast<std::size_t>(line * lineStep + i * step)] = sum / static_cast<double>(end - begin);
            }
        }
        return to;
    };
    return along(along(values, width, 1, height, width), height, width, width, 1);
}

double meanOf(const glm::dvec3& value) { return (value.r + value.g + value.b) / 3.0; }

// Both halves as they were and as they are denoised.
class Measurement {
public:
    Measurement(const glm::uvec2& size, DenoisedHalf first, DenoisedHalf second)
        : size_(size),
          noisyA_(std::move(first.noisy)),
          noisyB_(std::move(second.noisy)),
          a_(std::move(first.denoised)),
          b_(std::move(second.denoised)),
          samplesA_(std::move(first.samples)),
          samplesB_(std::move(second.samples))
    {
        double sum = 0.0;
        for (std::size_t i = 0; i < a_.size(); ++i) {
            sum += meanOf(radiance(i));
        }
        mean_ = sum / static_cast<double>(a_.size());
        for (std::size_t i = 0; i < a_.size(); ++i) {
            weights_.push_back(weightOf(0.5 * (glm::dvec3(noisyA_[i]) + glm::dvec3(noisyB_[i]))));
        }
    }

    void keepNoisyTiles();
    DenoisedPicture picture() const;

private:
    glm::vec3 radiance(std::size_t i) const { return 0.5F * (a_[i] + b_[i]); }
    glm::dvec3 squaredError(std::size_t i) const { return squaredDifference(a_, b_, i) / 4.0 + product(i); }
    glm::dvec3 noisySquaredError(std::size_t i) const { return squaredDifference(noisyA_, noisyB_, i) / 4.0; }
    static glm::dvec3 squaredDifference(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b, std::size_t i)
    {
        const glm::dvec3 difference = glm::dvec3(a[i]) - glm::dvec3(b[i]);
        return difference * difference;
    }
    // What was taken from a half.
    static glm::dvec3 residual(const std::vector<glm::vec3>& noisy, const std::vector<glm::vec3>& denoised, std::size_t i)
    {
        return glm::dvec3(noisy[i]) - glm::dvec3(denoised[i]);
    }
    glm::dvec3 product(std::size_t i) const { return residual(noisyA_, a_, i) * residual(noisyB_, b_, i); }
    PixelError errorOf(std::size_t i) const
    {
        const glm::dvec3 u = residual(noisyA_, a_, i), v = residual(noisyB_, b_, i);
        return {meanOf(squaredDifference(a_, b_, i)) / 4.0, meanOf(u * v), meanOf(u * u - v * v) / 2.0,
                balanceOf(samplesA_[i], samplesB_[i])};
    }

    // Of a squared error in relMSE, relative to this radiance (compare_images.hpp).
    glm::dvec3 weightOf(const glm::dvec3& radiance) const { return 1.0 / (radiance * radiance + 0.01 * mean_ * mean_); }
    // Of the halves' variances, which are as the inverse of their samples.
    static double balanceOf(double first, double second) { return 4.0 * first * second / ((first + second) * (first + second)); }

    glm::uvec2 size_;
    std::vector<glm::vec3> noisyA_, noisyB_, a_, b_;
    std::vector<std::uint32_t> samplesA_, samplesB_;
    double mean_ = 0.0;
    std::vector<glm::dvec3> weights_;  // of relMSE
    std::size_t kept_ = 0;             // pixels that stay noisy
};

void Measurement::keepNoisyTiles()
{
    forEachTile(size_, [&](const std::vector<std::size_t>& pixels) {
        Verdict absolute, relative;
        for (const std::size_t i : pixels) {
            const glm::dvec3 harm = squaredError(i) - noisySquaredError(i);
            absolute.add(meanOf(harm));
            relative.add(meanOf(weightOf(glm::dvec3(radiance(i))) * harm));  // the noisy radiance has the noise of `harm`, which flatters
        }
        if (absolute.isWorse() || relative.isWorse()) {
            kept_ += pixels.size();
            for (const std::size_t i : pixels) {
                a_[i] = noisyA_[i];
                b_[i] = noisyB_[i];
            }
        }
    });
}

DenoisedPicture Measurement::picture() const
{
    DenoisedPicture picture;
    std::vector<PixelError> mse;
    std::vector<glm::dvec3> squares;
    const auto count = static_cast<double>(a_.size());
    for (std::size_t i = 0; i < a_.size(); ++i) {
        picture.radiance.push_back(radiance(i));
        mse.push_back(errorOf(i));
        squares.push_back(squaredError(i));
        picture.measured.relMse += meanOf(weights_[i] * squares.back()) / count;
        picture.measured.noisyMse += meanOf(noisySquaredError(i)) / count;
        picture.measured.noisyRelMse += meanOf(weights_[i] * noisySquaredError(i)) / count;
    }
    picture.noisyShare = static_cast<double>(kept_) / count;
    picture.measured.mean = mean_;
    picture.measured.mse = intervalOf(mse);
    for (const glm::dvec3& square : averageAround(size_, squares)) {
        picture.error.emplace_back(glm::sqrt(glm::max(square, glm::dvec3(0.0))));
    }
    return picture;
}

}  // namespace

DenoisedHalf noisyHalf(const Film& film)
{
    DenoisedHalf half;
    for (const PixelMoments& pixel : shownPixels(film)) {
        half.noisy.push_back(pixel.mean);
        half.samples.push_back(pixel.count);
        // Means of equal samples differ by rounding: by up to 2^-24 of the mean for each of at most 128 samples of a block.
        const glm::vec3 rounding = 0x1p-17F * pixel.mean, variance = computeVarianceOfMean(pixel);
        half.background.push_back(pixel.alpha == 0.0F && glm::all(glm::lessThanEqual(variance, rounding * rounding)));
    }
    return half;
}

// A lamp's rim is as noisy as light that is hard to find, and denoisers spread it over the sky behind.
DenoisedPicture joinHalves(const glm::uvec2& size, std::array<DenoisedHalf, 2> halves)
{
    for (DenoisedHalf& half : halves) {
        for (std::size_t i = 0; i < half.noisy.size(); ++i) {
            half.denoised[i] = half.background[i] ? half.noisy[i] : half.denoised[i];
        }
    }
    Measurement measurement(size, std::move(halves[0]), std::move(halves[1]));
    measurement.keepNoisyTiles();
    return measurement.picture();
}

Film showDenoised(Film film, const std::vector<glm::vec3>& radiance)
{
    film.splats.clear();
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        film.pixels[i].mean = radiance[i];
    }
    return film;
}

bool hasBothHalves(const FilmHalves& halves)
{
    return std::ranges::all_of(halves.films(), [](const Film& film) {
        return !film.pixels.empty() && std::ranges::none_of(film.pixels, [](const PixelMoments& pixel) { return pixel.count == 0; });
    });
}

std::optional<DenoisedPicture> denoiseHalves(const FilmHalves& halves, const Denoiser& denoiser)
{
    std::array<DenoisedHalf, 2> joined;
    for (std::size_t i = 0; i < 2; ++i) {
        auto denoised = denoiser(halves.films()[i]);
        if (!denoised) {
            return std::nullopt;
        }
        joined[i] = noisyHalf(halves.films()[i]);
        joined[i].denoised = *std::move(denoised);
    }
    const Film& film = halves.films()[0];
    return joinHalves({film.width, film.height}, std::move(joined));
}

}  // namespace glim
