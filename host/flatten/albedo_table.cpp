#include "host/flatten/albedo_table.hpp"

#include "host/bvh/parallel_for.hpp"
#include "host/flatten/albedo_parts.hpp"
#include "shaders/shared/microfacets.h"

#include <cmath>
#include <numbers>
#include <thread>

namespace glim {
namespace {

using std::numbers::pi;

constexpr std::size_t kNodes = 32;

double lambda(double cosine, double alpha)
{
    const double tangent2 = (1.0 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * tangent2) - 1.0);
}

// a and b at a cosine and an alpha above 0: the integral of F G2 (v.h) / (v.z h.z) over the normals h, D(h) h.z dh, whose reflection of v
// is above the horizon. Slopes are alpha tan(beta) towards the azimuth phi; then D(h) h.z dh = sin(beta) cos(beta) / pi dbeta dphi. For
// each phi the end of beta is known in closed form, so the integrand is smooth inside; substitutions put more nodes at the ends.
glm::dvec2 integrateAlbedo(const GaussRule& rule, double cosine, double alpha)
{
    const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine)), lambdaV = lambda(cosine, alpha);
    glm::dvec2 sum(0.0);
    for (std::size_t i = 0; i < kNodes; ++i) {
        // The half circles that face v and face away, each alike on both sides of its middle.
        const double t = std::abs(rule.nodes[i]), middle = rule.nodes[i] < 0.0 ? pi : 0.0;
        const double phi = middle + pi / 16.0 * t * (15.0 - 10.0 * t * t + 3.0 * t * t * t * t);
        const double phiWeight = 15.0 / 16.0 * pi * (1.0 - t * t) * (1.0 - t * t) * rule.weights[i];
        const double horizon = 0.5 * (0.5 * pi + std::atan2(sine * std::cos(phi), cosine));
        const double end = std::atan2(std::sin(horizon), alpha * std::cos(horizon));
        for (std::size_t j = 0; j < kNodes; ++j) {
            const double s = 0.5 * (rule.nodes[j] + 1.0);
            const double beta = end * (1.0 - s * s * s), weight = phiWeight * end * 3.0 * s * s * 0.5 * rule.weights[j];
            const double slope = alpha * std::tan(beta), hz = 1.0 / std::sqrt(1.0 + slope * slope);
            const double vh = hz * (cosine + slope * sine * std::cos(phi));
            const double lz = 2.0 * vh * hz - cosine;
            if (!(lz > 0.0) || !(vh > 0.0)) {
                continue;
            }
            const double visible = vh / (cosine * hz * (1.0 + lambdaV + lambda(lz, alpha)));
            const double value = 2.0 * weight * std::sin(beta) * std::cos(beta) / pi * visible, schlick = fifthPower(1.0 - vh);
            sum += glm::dvec2(1.0 - schlick, schlick) * value;
        }
    }
    return sum;
}

double rootAt(std::size_t i) { return static_cast<double>(i) / (kAlbedoSize - 1); }

// Of row j. A smooth surface, alpha 0, reflects what Schlick says; light along the surface all of it.
std::vector<glm::dvec2> makeRow(const GaussRule& rule, std::size_t j)
{
    const double alpha = std::pow(rootAt(j), 4.0);
    std::vector<glm::dvec2> row;
    for (std::size_t i = 0; i < kAlbedoSize; ++i) {
        const double cosine = std::max(std::pow(rootAt(i), 4.0), 1e-9), schlick = fifthPower(1.0 - cosine);
        const glm::dvec2 ab = j == 0 ? glm::dvec2(1.0 - schlick, schlick) : integrateAlbedo(rule, cosine, alpha);
        row.emplace_back(rounded(ab.x), rounded(ab.y));
    }
    return row;
}

// 2 int f(cosine) cosine dcosine of the function that the row's bilinear look-up gives, exactly: linear in x between columns, and the
// cosine is x^4.
glm::dvec2 averageOverCosines(const std::vector<glm::dvec2>& row)
{
    glm::dvec2 sum(0.0);
    for (std::size_t i = 0; i + 1 < kAlbedoSize; ++i) {
        const double x0 = rootAt(i), x1 = rootAt(i + 1);
        const double m8 = (std::pow(x1, 8.0) - std::pow(x0, 8.0)) / 8.0, m9 = (std::pow(x1, 9.0) - std::pow(x0, 9.0)) / 9.0;
        const glm::dvec2 slope = (row[i + 1] - row[i]) / (x1 - x0);
        sum += 8.0 * ((row[i] - slope * x0) * m8 + slope * m9);
    }
    return {rounded(sum.x), rounded(sum.y)};
}

double sheenLambda(double cosine, double alpha)
{
    const SheenFit fit = fitSheen(alpha);
    const auto log = [&fit](double x) { return evalSheenFit(fit, x, std::pow(x, fit.c)); };
    return std::exp(cosine < 0.5 ? log(cosine) : 2.0 * log(0.5) - log(1.0 - cosine));
}

// Over wi with z = x^4 and the azimuth pi (1 - y^2) from wo's: dense at the horizon opposite to wo, where the lobe lies.
double integrateSheen(const GaussRule& rule, double cosine, double alpha)
{
    const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine)), lambdaV = sheenLambda(cosine, alpha);
    double sum = 0.0;
    for (std::size_t i = 0; i < kNodes; ++i) {
        const double x = 0.5 * (rule.nodes[i] + 1.0), z = std::pow(x, 4.0), r = std::sqrt((1.0 - z) * (1.0 + z));
        const double masking = (1.0 + lambdaV + sheenLambda(z, alpha)) * 4.0 * cosine;
        double ring = 0.0;
        for (std::size_t j = 0; j < kNodes; ++j) {
            const double y = 0.5 * (rule.nodes[j] + 1.0), phi = pi * (1.0 - y * y);
            const double hx = sine + r * std::cos(phi), hy = r * std::sin(phi), hz = cosine + z;
            const double sine2 = (hx * hx + hy * hy) / (hx * hx + hy * hy + hz * hz);
            ring += std::pow(sine2, 0.5 / alpha) * 2.0 * pi * 2.0 * y * 0.5 * rule.weights[j];
        }
        sum += ring * (2.0 + 1.0 / alpha) / (2.0 * pi) / masking * 4.0 * x * x * x * 0.5 * rule.weights[i];
    }
    return sum;
}

}  // namespace

std::vector<uvec4> makeSheenTable()
{
    constexpr double kMinAlpha = 1e-4, kMinCosine = 1e-5;  // kMinSheenRoughness squared; below, the lobe is not resolved
    const GaussRule rule(kNodes);
    std::vector<std::vector<double>> rows(kAlbedoSize);
    parallelFor(rows.size(), std::thread::hardware_concurrency(), [&](std::size_t j) {
        for (std::size_t i = 0; i < kAlbedoSize; ++i) {
            rows[j].push_back(rounded(
                integrateSheen(rule, std::max(std::pow(rootAt(i), 4.0), kMinCosine), std::max(std::pow(rootAt(j), 4.0), kMinAlpha))));
        }
    });
    std::vector<uvec4> table;
    for (std::size_t j = 0; j < kAlbedoSize; ++j) {
        const std::vector<double>& upper = rows[std::min<std::size_t>(j + 1, kAlbedoSize - 1)];
        for (std::size_t i = 0; i < kAlbedoSize; ++i) {
            const std::size_t next = std::min<std::size_t>(i + 1, kAlbedoSize - 1);
            table.push_back(texelOf({rows[j][i], rows[j][next]}, {upper[i], upper[next]}));
        }
    }
    return table;
}

std::vector<uvec4> makeAlbedoTable()
{
    const GaussRule rule(kNodes);
    std::vector<std::vector<glm::dvec2>> rows(kAlbedoSize);
    parallelFor(rows.size(), std::thread::hardware_concurrency(), [&](std::size_t j) { rows[j] = makeRow(rule, j); });
    std::vector<uvec4> table;
    std::vector<glm::dvec2> averages;
    for (const std::vector<glm::dvec2>& row : rows) {
        pushTexels(table, row);
        averages.push_back(averageOverCosines(row));
    }
    pushTexels(table, averages);
    return table;
}

}  // namespace glim
