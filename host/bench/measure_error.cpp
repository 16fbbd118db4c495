#include "host/bench/measure_error.hpp"

#include "host/measure/compare_images.hpp"

#include <cmath>
#include <numeric>

namespace glim {
namespace {

std::vector<float> errorTerms(const Picture& picture, const Picture& reference, double epsilon)
{
    std::vector<float> terms(3 * picture.radiance.size(), 0.0F);
    for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
        if (isFinite(picture.radiance[i]) && isFinite(reference.radiance[i])) {
            for (int c = 0; c < 3; ++c) {
                const double r = static_cast<double>(reference.radiance[i][c]);
                const double difference = static_cast<double>(picture.radiance[i][c]) - r;
                const double scale = std::sqrt(r * r + epsilon);
                terms[3 * i + static_cast<std::size_t>(c)] = difference != 0.0 ? static_cast<float>(difference / scale) : 0.0F;
            }
        }
    }
    return terms;
}

double product(const std::vector<float>& a, const std::vector<float>& b, std::size_t begin, std::size_t end)
{
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
        sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    }
    return sum;
}

}  // namespace

PictureError measureError(const Picture& picture, const Picture& reference)
{
    const Comparison comparison = compareImages(picture, reference);
    return {meanRadiance(picture), comparison.errors.mse, comparison.errors.relMse, comparison.trimmed.kept.relMse,
            errorTerms(picture, reference, comparison.epsilon)};
}

// The error of the floor is that of a sum of squares of normal numbers, of which a pixel's three channels are taken to be one.
Floor measureFloor(const Picture& reference)
{
    const auto noise = noiseOfReference(reference);
    if (!noise) {
        return {};
    }
    Picture shifted = reference;  // by one standard deviation: its terms squared are the variances
    for (std::size_t i = 0; i < shifted.radiance.size(); ++i) {
        shifted.radiance[i] += glm::sqrt(isFinite(reference.variance[i]) ? reference.variance[i] : glm::vec3(0.0F));
    }
    const std::vector<float> terms = errorTerms(shifted, reference, compareImages(shifted, reference).epsilon);
    double squares = 0.0;
    for (std::size_t i = 0; i < terms.size(); i += 3) {
        const double pixel = product(terms, terms, i, i + 3);
        squares += pixel * pixel;
    }
    return {noise->mse, noise->relMse, std::sqrt(2.0 * squares) / static_cast<double>(terms.size()), true};
}

Bias estimateBias(const std::vector<std::vector<float>>& terms, const Floor& floor)
{
    const std::size_t count = terms.size();
    std::vector<double> rows(count, 0.0);  // sums of the products with all others
    for (std::size_t a = 0; a < count; ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            const double mean = product(terms[a], terms[b], 0, terms[a].size()) / static_cast<double>(terms[a].size());
            rows[a] += mean;
            rows[b] += mean;
        }
    }
    const double n = static_cast<double>(count), total = std::accumulate(rows.begin(), rows.end(), 0.0);
    const double mean = total / (n * (n - 1.0));
    double squares = 0.0;
    for (const double row : rows) {
        const double without = (total - 2.0 * row) / ((n - 1.0) * (n - 2.0));
        squares += (without - mean) * (without - mean);
    }
    const double jackknife = (n - 1.0) / n * squares;
    return {mean - floor.relMse, std::sqrt(jackknife + floor.relMseError * floor.relMseError)};
}

}  // namespace glim
