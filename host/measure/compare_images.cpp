#include "host/measure/compare_images.hpp"

#include "host/error.hpp"
#include "host/measure/confidence.hpp"
#include "host/measure/float_range.hpp"
#include "host/render/robust_radiance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace glim {
namespace {

constexpr std::size_t kMinBlocks = 16;  // below, a normal interval from the blocks' spread would be too narrow
constexpr double kAbsoluteEpsilon = 0.01;

[[noreturn]] void refuseOtherPart(const char* what, std::uint32_t begin, std::uint32_t expected)
{
    throw InputError(MessageId::Mismatch, {"The pictures begin with ", part::place(what), " ", part::value(std::to_string(begin)), " and ",
                                           part::expected(std::to_string(expected)), " of a larger one, expected the same ", what, "."});
}

void checkSizes(const Picture& picture, const Picture& reference)
{
    if (picture.width != reference.width || picture.height != reference.height) {
        throw InputError(
            MessageId::Mismatch,
            {"The pictures are ", part::value(std::to_string(picture.width) + "x" + std::to_string(picture.height)), " and ",
             part::expected(std::to_string(reference.width) + "x" + std::to_string(reference.height)), ", expected equal sizes."});
    }
    if (picture.columnsLeft != reference.columnsLeft) {
        refuseOtherPart("columns", picture.columnsLeft, reference.columnsLeft);
    }
    if (picture.rowsAbove != reference.rowsAbove) {
        refuseOtherPart("rows", picture.rowsAbove, reference.rowsAbove);
    }
}

std::vector<bool> findComparable(const Picture& picture, const Picture& reference, Comparison& result)
{
    std::vector<bool> comparable(picture.radiance.size());
    for (std::size_t i = 0; i < comparable.size(); ++i) {
        const bool finite = isFinite(picture.radiance[i]), referenceFinite = isFinite(reference.radiance[i]);
        result.nonFinite += !finite;
        result.nonFiniteInReference += !referenceFinite;
        comparable[i] = finite && referenceFinite;
        result.compared += comparable[i];
    }
    if (result.compared == 0) {
        throw InputError(MessageId::Empty, {"No pixel is finite in both pictures, expected at least one to compare."});
    }
    return comparable;
}

// Adds the terms of one value with squared error `square` against reference value `r`.
void addTerms(SquaredErrors& sums, double square, double r, double epsilon)
{
    sums.mse += square;
    sums.relMseAbsolute += square / (r * r + kAbsoluteEpsilon);
    // Only a black reference has no epsilon; there an exact zero is right and anything else infinitely wrong.
    sums.relMse += square == 0.0 ? 0.0 : square / (r * r + epsilon);
}

void divide(SquaredErrors& sums, double terms)
{
    sums.mse /= terms;
    sums.relMse /= terms;
    sums.relMseAbsolute /= terms;
}

SquaredErrors meanOfErrors(const std::vector<SquaredErrors>& pixels)
{
    SquaredErrors sums;
    for (const SquaredErrors& pixel : pixels) {
        sums.mse += pixel.mse;
        sums.relMse += pixel.relMse;
        sums.relMseAbsolute += pixel.relMseAbsolute;
    }
    divide(sums, static_cast<double>(pixels.size()));
    return sums;
}

void addErrors(const Picture& picture, const Picture& reference, const std::vector<bool>& comparable, Comparison& result)
{
    result.epsilon = relativeEpsilon(reference);
    const double mapeFloor = 0.01 * std::abs(meanRadiance(reference));
    double largest = -1.0;
    std::vector<SquaredErrors> pixels;
    for (std::size_t i = 0; i < comparable.size(); ++i) {
        SquaredErrors terms;
        for (int c = 0; comparable[i] && c < 3; ++c) {
            const double r = static_cast<double>(reference.radiance[i][c]);
            const double difference = static_cast<double>(picture.radiance[i][c]) - r;
            addTerms(terms, difference * difference, r, result.epsilon);
            result.mape += difference != 0 ? std::abs(difference) / (std::abs(r) + mapeFloor) : 0.0;
            if (std::abs(difference) > largest) {
                largest = std::abs(difference);
                const auto pixel = static_cast<std::uint32_t>(i);
                result.maxError = {pixel % picture.width, pixel / picture.width, c, picture.radiance[i][c], reference.radiance[i][c]};
            }
        }
        if (comparable[i]) {
            divide(terms, 3.0);
            pixels.push_back(terms);
        }
    }
    result.errors = meanOfErrors(pixels);
    result.trimmed = trimErrors(pixels);
    result.mape /= 3.0 * static_cast<double>(result.compared);
}

// Sums over a region: of the picture, of the reference, and of their variances.
struct Sums {
    glm::dvec3 picture{0.0}, reference{0.0}, variance{0.0}, referenceVariance{0.0};
};

void addPixel(Sums& sums, const Picture& picture, const Picture& reference, std::size_t i)
{
    sums.picture += glm::dvec3(picture.radiance[i]);
    sums.reference += glm::dvec3(reference.radiance[i]);
    const glm::dvec3 unknown(std::numeric_limits<double>::quiet_NaN());
    sums.variance += picture.variance.empty() ? unknown : glm::dvec3(picture.variance[i]);
    sums.referenceVariance += reference.variance.empty() ? unknown : glm::dvec3(reference.variance[i]);
}

std::vector<Sums> sumBlocks(const Picture& picture, const Picture& reference, const std::vector<bool>& comparable)
{
    const std::size_t columns = (picture.width + kBlockSide - 1) / kBlockSide;
    const std::size_t rows = (picture.height + kBlockSide - 1) / kBlockSide;
    std::vector<Sums> blocks(columns * rows);
    for (std::size_t i = 0; i < comparable.size(); ++i) {
        if (comparable[i]) {
            const std::size_t x = i % picture.width, y = i / picture.width;
            addPixel(blocks[y / kBlockSide * columns + x / kBlockSide], picture, reference, i);
        }
    }
    return blocks;
}

// Variance of sum(x) - ratio sum(r) from how the blocks scatter about it.
double scatter(const std::vector<Sums>& blocks, const glm::dvec3& weights, double ratio)
{
    double squares = 0.0;
    for (const Sums& block : blocks) {
        const double residual = glm::dot(weights, block.picture - ratio * block.reference);
        squares += residual * residual;
    }
    const double count = static_cast<double>(blocks.size());
    return squares * count / (count - 1.0);
}

MeanRatio ratioWithin(double value, double standardError)
{
    const double halfWidth = twoSidedLimit(0.05) * standardError;
    return {value, value - halfWidth, value + halfWidth};
}

// `variance`, `radiance`: sums over so many pixels.
bool isVarianceKnown(const glm::dvec3& variance, const glm::dvec3& radiance, std::size_t pixels)
{
    const double values = 3.0 * static_cast<double>(pixels);
    return isWithinFloat((variance.r + variance.g + variance.b) / values, (radiance.r + radiance.g + radiance.b) / values);
}

void addRatios(const std::vector<Sums>& blocks, Comparison& result)
{
    Sums total;
    for (const Sums& block : blocks) {
        total.picture += block.picture;
        total.reference += block.reference;
        total.variance += block.variance;
        total.referenceVariance += block.referenceVariance;
    }
    const bool knowsVariance = isVarianceKnown(total.variance, total.picture, result.compared) &&
                               isVarianceKnown(total.referenceVariance, total.reference, result.compared);
    result.intervalSource = knowsVariance                 ? IntervalSource::Variance
                            : blocks.size() >= kMinBlocks ? IntervalSource::Blocks
                                                          : IntervalSource::None;
    auto standardError = [&](const glm::dvec3& weights) {
        const double reference = glm::dot(weights, total.reference);
        const double ratio = glm::dot(weights, total.picture) / reference;
        switch (result.intervalSource) {
        case IntervalSource::Variance:
            return glm::dot(weights, glm::sqrt(total.variance + ratio * ratio * total.referenceVariance)) / reference;
        case IntervalSource::Blocks: return std::sqrt(scatter(blocks, weights, ratio)) / reference;
        case IntervalSource::None: break;
        }
        return std::numeric_limits<double>::quiet_NaN();
    };
    auto ratioOf = [&](const glm::dvec3& weights) {
        const double value = glm::dot(weights, total.picture) / glm::dot(weights, total.reference);
        return ratioWithin(value, standardError(weights));
    };
    result.ratio = {ratioOf({1, 0, 0}), ratioOf({0, 1, 0}), ratioOf({0, 0, 1})};
    result.ratioOfAll = ratioOf({1, 1, 1});
}

bool isUnknown(const glm::vec3& variance) { return std::isnan(variance.x + variance.y + variance.z); }

std::optional<SquaredErrors> errorsRelativeTo(const std::vector<glm::dvec3>& radiance, const Picture& picture)
{
    const double mean = meanRadiance(picture), epsilon = relativeEpsilon(picture);
    SquaredErrors sums;
    std::size_t known = 0;
    for (std::size_t i = 0; i < picture.variance.size(); ++i) {
        if (isFinite(picture.radiance[i]) && !isUnknown(picture.variance[i])) {
            ++known;
            for (int c = 0; c < 3; ++c) {
                addTerms(sums, static_cast<double>(picture.variance[i][c]), radiance[i][c], epsilon);
            }
        }
    }
    if (known == 0) {
        return std::nullopt;
    }
    divide(sums, 3.0 * static_cast<double>(known));
    const bool isKnown = isWithinFloat(sums.mse, mean) && isWithinFloat(sums.relMse * epsilon, mean);
    return isKnown ? std::optional(sums) : std::nullopt;
}

}  // namespace

TrimmedErrors trimErrors(const std::vector<SquaredErrors>& pixels)
{
    TrimmedErrors result;
    result.dropped = pixels.size() / 1000;
    std::vector<double> terms(pixels.size());
    for (double SquaredErrors::*metric : {&SquaredErrors::mse, &SquaredErrors::relMse, &SquaredErrors::relMseAbsolute}) {
        std::transform(pixels.begin(), pixels.end(), terms.begin(), std::mem_fn(metric));
        const auto kept = terms.begin() + static_cast<std::ptrdiff_t>(result.dropped);
        std::nth_element(terms.begin(), kept, terms.end(), std::greater<>());
        const double droppedSum = std::accumulate(terms.begin(), kept, 0.0);
        const double keptSum = std::accumulate(kept, terms.end(), 0.0);
        result.kept.*metric = keptSum / static_cast<double>(terms.size() - result.dropped);
        result.share.*metric = droppedSum == 0.0 ? 0.0 : droppedSum / (droppedSum + keptSum);
    }
    return result;
}

Comparison compareImages(const Picture& picture, const Picture& reference)
{
    checkSizes(picture, reference);
    Comparison result;
    const std::vector<bool> comparable = findComparable(picture, reference, result);
    addErrors(picture, reference, comparable, result);
    addRatios(sumBlocks(picture, reference, comparable), result);
    result.withoutVariance =
        picture.variance.empty() ? picture.radiance.size() : static_cast<std::size_t>(std::ranges::count_if(picture.variance, isUnknown));
    result.noise = estimateErrors(picture);
    result.referenceNoise = estimateReferenceNoise(reference);
    return result;
}

std::optional<SquaredErrors> measureErrors(const Picture& picture, const Picture& reference)
{
    const double epsilon = relativeEpsilon(reference);
    SquaredErrors sums;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
        const glm::dvec3 x(picture.radiance[i]), r(reference.radiance[i]);
        if (isFinite(x) && isFinite(r)) {
            ++compared;
            for (int c = 0; c < 3; ++c) {
                addTerms(sums, (x[c] - r[c]) * (x[c] - r[c]), r[c], epsilon);
            }
        }
    }
    if (compared == 0) {
        return std::nullopt;
    }
    divide(sums, 3.0 * static_cast<double>(compared));
    return sums;
}

std::optional<SquaredErrors> estimateErrors(const Picture& picture)
{
    return estimateErrors(picture, robustRadiance(picture.width, picture.height, picture.radiance, picture.variance));
}

std::optional<SquaredErrors> estimateErrors(const Picture& picture, const std::vector<glm::dvec3>& likely)
{
    if (!std::ranges::all_of(picture.radiance, [](const glm::vec3& radiance) { return isFinite(radiance); })) {
        return std::nullopt;
    }
    return errorsRelativeTo(likely, picture);
}

std::optional<SquaredErrors> estimateReferenceNoise(const Picture& reference)
{
    return errorsRelativeTo({reference.radiance.begin(), reference.radiance.end()}, reference);
}

double meanRadiance(const Picture& picture)
{
    glm::dvec3 sum(0.0);
    std::size_t count = 0;
    for (const glm::vec3& value : picture.radiance) {
        if (isFinite(value)) {
            sum += glm::dvec3(value);
            ++count;
        }
    }
    return (sum.x + sum.y + sum.z) / (3.0 * static_cast<double>(count));
}

double relativeEpsilon(const Picture& reference)
{
    const double mean = meanRadiance(reference);
    return 0.01 * mean * mean;
}

Image signedDifference(const Picture& picture, const Picture& reference)
{
    checkSizes(picture, reference);
    Image image;
    image.width = picture.width;
    image.height = picture.height;
    const char* letters[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        auto& plane = image.channels[letters[c]];
        for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
            plane.push_back(picture.radiance[i][c] - reference.radiance[i][c]);
        }
    }
    return image;
}

}  // namespace glim
