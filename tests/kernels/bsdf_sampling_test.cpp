// Sampled directions of the lobes and of the whole material: chi-square against their densities, weights against quadrature, corners.
#include "shaders/shared/features.h"
#include "test_kernels.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/albedo_buffer.hpp"
#include "tests/support/any_bsdf.h"
#include "tests/support/kernel_test.hpp"
#include "tests/support/materials.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <iostream>
#include <optional>

namespace glim::bsdf_sampling_test {

constexpr double kPi = std::numbers::pi;
constexpr std::array<float, 5> kRoughnesses = {0.04F, 0.1F, 0.2F, 0.5F, 1.0F};
constexpr std::array<double, 5> kCosines = {1.0, 0.7, 0.3, 0.05, 0.01};
constexpr double kAzimuth = 0.7;
constexpr uint kDelta = 1;  // kBsdfDelta

// An axis of cells, even in asinh((x - center) / width): fine about the center, growing in proportion to the distance from it.
class Axis {
public:
    Axis(double begin, double end, double center, double width)
        : center_(center),
          width_(width),
          first_(std::asinh((begin - center) / width)),
          last_(std::asinh((end - center) / width))
    {}

    std::size_t cellOf(double x) const
    {
        const double s = (std::asinh((x - center_) / width_) - first_) / (last_ - first_);
        return static_cast<std::size_t>(std::clamp(static_cast<int>(s * kCells), 0, static_cast<int>(kCells) - 1));
    }

    // Of four nodes in each cell: sine, cosine, weight.
    void writeNodes(vec3* nodes) const
    {
        constexpr std::array<double, 4> kNodes = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
        constexpr std::array<double, 4> kWeights = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538};
        const double step = (last_ - first_) / kCells;
        for (std::size_t i = 0; i < kCells * kCellNodes; ++i) {
            const double s = first_ + step * (static_cast<double>(i / kCellNodes) + 0.5 + 0.5 * kNodes[i % kCellNodes]);
            const double x = center_ + width_ * std::sinh(s);
            nodes[i] = glm::dvec3(std::sin(x), std::cos(x), 0.5 * step * kWeights[i % kCellNodes] * width_ * std::cosh(s));
        }
    }

private:
    double center_, width_, first_, last_;
};

// Cells of one side of a case's surface, fine where its narrowest lobe is.
struct Side {
    std::size_t bsdf;
    float z;
    bool polar;
    double azimuth;
    Axis longitude, latitude;
    double begin, end;  // of the longitude
};

double etaOf(const MaterialCase& m)
{
    const double ior = static_cast<double>(m.ior);
    return m.solid > 0.0F ? (m.inside > 0.0F ? 1.0 / ior : ior) : 1.0;
}

// `further`: of the far side of a solid, where no facet refracts to.
Side makeSide(std::size_t at, const BsdfCase& bsdf, float z, bool further = false)
{
    const MaterialCase& m = bsdf.material;
    const auto square = [](float x) { return std::max(1.6e-3, static_cast<double>(x * x)); };
    double width = 2.0 * square(m.roughness);
    if (m.clearcoat > 0.0F && m.clearcoatRoughness > 0.04F) {
        width = std::min(width, 2.0 * square(m.clearcoatRoughness));
    }
    // The facets' normals of an anisotropic lobe lie along x, and what they reflect at one latitude towards y. Else x is along wo.
    const glm::dvec3 wo(bsdf.wo);
    const double azimuth = m.anisotropy > 0.0F ? 0.0 : kAzimuth;
    double x = -(wo.x * std::cos(azimuth) + wo.y * std::sin(azimuth)), y = wo.x * std::sin(azimuth) - wo.y * std::cos(azimuth);
    const double half = 0.5 * kPi, wide = std::max(wo.z, 0.01);
    if (z < 0.0F && m.solid > 0.0F) {
        // No facet that faces up refracts across a circle about the normal.
        const double eta = etaOf(m), edge = std::acos(std::min(1.0, wo.z / eta));
        const double theta = std::asin(std::min(1.0, std::hypot(x, y) / eta));
        width *= 0.5 * std::abs(eta - 1.0);
        const bool inner = (eta > 1.0) != further;
        const double begin = inner ? 0.0 : edge, end = inner ? edge : half;
        const Axis longitude(begin, end, further ? edge : theta, further ? 1.0 : width);
        return {at,    z,  true, azimuth + kPi, longitude, Axis(-kPi, kPi, 0.0, further ? 1.0 : width / std::max(std::sin(theta), 1e-3)),
                begin, end};
    }
    const double longitude = std::atan2(x, std::sqrt(std::max(0.0, 1.0 - x * x - y * y)));
    return {at, z, false, azimuth, Axis(-half, half, longitude, width), Axis(-half, half, std::asin(y), width * wide), -half, half};
}

bool transmits(const BsdfCase& c)
{
    return c.what == kSampleTransmission ||
           (c.what == kSamplePrincipled && (c.material.transmission > 0.0F || c.material.diffuseTransmission > 0.0F));
}

// Features of the kernels that the cases need: fewer compile faster.
FeatureMask getFeatures(const std::vector<BsdfCase>& cases)
{
    FeatureMask features = kFeaturePrincipled;
    for (const BsdfCase& c : cases) {
        const MaterialCase& m = c.material;
        features |= (m.clearcoat > 0.0F ? kFeatureClearcoat : 0U) | (m.sheenColor != vec3(0.0F) ? kFeatureSheen : 0U) |
                    (m.anisotropy > 0.0F ? kFeatureAnisotropy : 0U) | (m.film > 0.0F ? kFeatureIridescence : 0U) |
                    (m.transmission > 0.0F ? kFeatureTransmission | kFeatureRoughTransmission : 0U) |
                    (m.diffuseTransmission > 0.0F ? kFeatureDiffuseTransmission : 0U);
    }
    return features;
}

class Sampled {
public:
    explicit Sampled(const std::vector<BsdfCase>& cases)
        : cases_(cases)
    {}

    std::vector<SampledDirection> sample(uint points, uint count, FeatureMask features, uint seed = 1) const
    {
        std::vector<BsdfCase> cases = cases_;
        for (BsdfCase& c : cases) {
            c.points = points;
        }
        const std::size_t threads = cases.size() * count;
        KernelTest test(test_kernels::bsdf_sampling_test);
        test.parameters().seed = seed;
        test.pass().sampleCount = count;
        test.features(features).buffers(albedos_.bound()).cases(cases).resultsOf<SampledDirection>(threads);
        test.threads(static_cast<std::uint32_t>(threads)).run();
        return test.results<SampledDirection>();
    }

    // By side and cell: integrals of the density and of the three channels.
    std::vector<glm::vec4> integrate(const std::vector<Side>& sides) const
    {
        std::vector<CellsCase> cells(sides.size());
        for (std::size_t i = 0; i < sides.size(); ++i) {
            cells[i].bsdf = cases_[sides[i].bsdf];
            cells[i].side = sides[i].z;
            cells[i].polar = sides[i].polar ? 1 : 0;
            cells[i].turn = glm::dvec2(std::cos(sides[i].azimuth), std::sin(sides[i].azimuth));
            sides[i].longitude.writeNodes(cells[i].longitudes);
            sides[i].latitude.writeNodes(cells[i].latitudes);
        }
        const std::size_t threads = sides.size() * kCells * kCells;
        KernelTest test(test_kernels::bsdf_cells_test);
        test.features(getFeatures(cases_)).buffers(albedos_.bound()).cases(cells).resultsOf<glm::vec4>(threads);
        test.threads(static_cast<std::uint32_t>(threads)).run();
        return test.results<glm::vec4>();
    }

    const std::vector<BsdfCase>& cases() const { return cases_; }

private:
    std::vector<BsdfCase> cases_;
    AlbedoBuffer albedos_;
};

// No value: wi is not in it.
std::optional<std::size_t> cellOf(const Side& side, const vec3& wi)
{
    const glm::dvec3 w(wi);
    const double c = std::cos(side.azimuth), s = std::sin(side.azimuth), x = w.x * c + w.y * s, y = w.y * c - w.x * s;
    const double longitude = side.polar ? std::atan2(std::hypot(x, y), std::abs(w.z)) : std::atan2(x, std::abs(w.z));
    const double latitude = side.polar ? std::atan2(y, x) : std::atan2(y, std::hypot(x, w.z));
    if (!(wi.z * side.z > 0.0F) || longitude < side.begin || longitude > side.end) {
        return std::nullopt;
    }
    return side.longitude.cellOf(longitude) * kCells + side.latitude.cellOf(latitude);
}

bool isContinuous(const SampledDirection& s) { return (s.flags & kDelta) == 0 && s.pdf > 0.0F; }

// Counts of samples by cell, and last the samples that no density gives: below the horizon, and of delta lobes.
std::vector<double> countsOf(const std::vector<Side>& sides, std::span<const SampledDirection> samples)
{
    std::vector<double> counts(sides.size() * kCells * kCells + 1);
    for (const SampledDirection& s : samples) {
        std::size_t place = counts.size() - 1;
        for (std::size_t i = 0; i < sides.size(); ++i) {
            if (const std::optional<std::size_t> cell = cellOf(sides[i], s.wi); cell && isContinuous(s)) {
                place = i * kCells * kCells + *cell;
            }
        }
        ++counts[place];
    }
    return counts;
}

struct Summary {
    double minP = 1.0, largestZ = 0.0, largestWeight = 0.0, difference = 0.0, variance = 0.0, tests = 0.0, excess = 0.0;
    std::vector<float> weights;
};

constexpr double kQuadrature = 3e-4;  // its error

// The case's sides lie at `first` in `integrals`.
void check(const std::vector<Side>& sides, std::span<const glm::vec4> integrals, std::span<const SampledDirection> hashed,
           std::size_t tests, Summary& summary)
{
    const auto n = static_cast<double>(hashed.size());
    glm::dvec4 total(0.0);
    std::vector<double> expected;
    for (const glm::vec4& integral : integrals) {
        total += glm::dvec4(integral);
        expected.push_back(n * static_cast<double>(integral.x));
    }
    expected.push_back(std::max(0.0, n * (1.0 - total.x)));
    summary.excess = std::max(summary.excess, total.x - 1.0);
    EXPECT_LE(total.x, 1.0 + kQuadrature) << "integral of the density";
    const ChiSquare test = computeChiSquare(countsOf(sides, hashed), expected);
    EXPECT_GE(test.p, familyLevel(tests)) << "chi-square " << test.statistic << " with " << test.cells << " cells";
    summary.minP = std::min(summary.minP, test.p);
    glm::dvec3 sum(0.0), squares(0.0);
    for (const SampledDirection& s : hashed) {
        const glm::dvec3 weight = isContinuous(s) ? glm::dvec3(s.weight) : glm::dvec3(0.0);
        sum += weight;
        squares += weight * weight;
        const float largest = std::max({s.weight.x, s.weight.y, s.weight.z});
        summary.weights.push_back(largest);
        summary.largestWeight = std::max(summary.largestWeight, static_cast<double>(largest));
    }
    for (int c = 0; c < 3; ++c) {
        const double mean = sum[c] / n, variance = (squares[c] / n - mean * mean) / n, truth = total[c + 1];
        const double difference = mean - truth, error = std::sqrt(std::max(0.0, variance));
        EXPECT_LE(std::abs(difference), scoreLimit(3 * tests) * error + kQuadrature) << "albedo " << mean << ", quadrature " << truth;
        summary.largestZ = std::max(summary.largestZ, std::abs(difference) > kQuadrature ? std::abs(difference) / error : 0.0);
        if (c == 0) {
            summary.difference += difference;
            summary.variance += variance;
            summary.tests += 1.0;
        }
    }
}

Summary checkSampling(const std::string& what, const std::vector<BsdfCase>& cases, uint count)
{
    const Sampled sampled(cases);
    std::vector<Side> sides;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (cases[i].what != kSampleTransmission) {
            sides.push_back(makeSide(i, cases[i], 1.0F));
        }
        if (transmits(cases[i])) {
            sides.push_back(makeSide(i, cases[i], -1.0F));
        }
        if (cases[i].what == kSamplePrincipled && cases[i].material.solid > 0.0F) {
            sides.push_back(makeSide(i, cases[i], -1.0F, true));
        }
    }
    const std::vector<glm::vec4> integrals = sampled.integrate(sides);
    Summary summary;
    for (int round = 0; round < testRounds(); ++round) {
        const auto hashed = sampled.sample(kPointsHashed, count, getFeatures(cases), static_cast<uint>(round) + 1);
        for (std::size_t i = 0, side = 0; i < cases.size(); ++i) {
            const std::size_t first = side;
            while (side < sides.size() && sides[side].bsdf == i) {
                ++side;
            }
            const MaterialCase& m = cases[i].material;
            SCOPED_TRACE(what + " " + std::to_string(i) + ": roughness " + std::to_string(m.roughness) + ", anisotropy " +
                         std::to_string(m.anisotropy) + ", cosine " + std::to_string(cases[i].wo.z) + ", ior " + std::to_string(m.ior));
            check({sides.begin() + static_cast<std::ptrdiff_t>(first), sides.begin() + static_cast<std::ptrdiff_t>(side)},
                  std::span(integrals).subspan(first * kCells * kCells, (side - first) * kCells * kCells),
                  std::span(hashed).subspan(i * count, count), cases.size() * static_cast<std::size_t>(testRounds()), summary);
        }
    }
    std::nth_element(summary.weights.begin(), summary.weights.begin() + static_cast<std::ptrdiff_t>(summary.weights.size() / 2),
                     summary.weights.end());
    const double difference = summary.difference / summary.tests, error = std::sqrt(summary.variance) / summary.tests;
    EXPECT_LE(std::abs(difference), 5.0 * error + kQuadrature) << what << ": mean of all albedos";
    std::cout << "  " << what << ": " << cases.size() << " cases, least p " << summary.minP << ", |z| of albedos up to " << summary.largestZ
              << ", their mean off by " << difference << " +- " << error << ", weights up to " << summary.largestWeight << ", median "
              << summary.weights[summary.weights.size() / 2] << '\n';
    return summary;
}

void addAll(std::vector<BsdfCase>& cases, uint what, const MaterialCase& material)
{
    for (const double cosine : kCosines) {
        if (what == kSamplePrincipled && testRounds() == 1 && (cosine == 0.7 || cosine == 0.05)) {
            continue;  // those of the lobes by themselves are sampled
        }
        // Anisotropic lobes are seen along and across.
        const double azimuth = material.anisotropy > 0.0F ? (cases.size() % 2 == 0 ? 0.0 : 0.5 * kPi) : kAzimuth;
        cases.push_back({directionAt(cosine, azimuth), what, kPointsHashed, material});
    }
}

TEST(BsdfSamplingTest, GgxFollowsItsDensity)
{
    std::vector<BsdfCase> cases;
    for (const float roughness : kRoughnesses) {
        for (const float anisotropy : {0.0F, 0.5F, 1.0F}) {
            MaterialCase m = plainMaterial(roughness);
            m.anisotropy = anisotropy;
            addAll(cases, kSampleGgx, m);
        }
    }
    EXPECT_LE(checkSampling("GGX", cases, 1 << 13).largestWeight, 1.0 + 1e-6);
}

TEST(BsdfSamplingTest, TransmissionFollowsItsDensity)
{
    std::vector<BsdfCase> cases;
    for (const float roughness : kRoughnesses) {
        for (const float ior : {1.1F, 1.5F, 1.0F / 1.5F, 2.4F}) {
            MaterialCase m = plainMaterial(roughness);
            m.solid = 1.0F;
            m.ior = ior;
            addAll(cases, kSampleTransmission, m);
        }
    }
    checkSampling("transmission", cases, 1 << 13);
}

TEST(BsdfSamplingTest, SheenFollowsItsDensity)
{
    std::vector<BsdfCase> cases;
    for (const float roughness : {0.07F, 0.1F, 0.2F, 0.5F, 1.0F}) {
        MaterialCase m = plainMaterial(1.0F);
        m.sheenRoughness = roughness;
        addAll(cases, kSampleSheen, m);
    }
    checkSampling("sheen", cases, 1 << 13);
}

// Layers one by one and together.
std::vector<BsdfCase> mixtures()
{
    std::vector<BsdfCase> cases;
    for (const float roughness : kRoughnesses) {
        if (roughness != 0.04F && roughness != 0.2F && roughness != 1.0F && testRounds() == 1) {
            continue;
        }
        for (const float metallic : {0.0F, 1.0F}) {
            addAll(cases, kSamplePrincipled, plainMaterial(roughness, metallic));
        }
        MaterialCase glass = plainMaterial(roughness);
        glass.base = vec3(0.9F);
        glass.transmission = 1.0F;
        addAll(cases, kSamplePrincipled, glass);  // a thin wall
        glass.solid = 1.0F;
        addAll(cases, kSamplePrincipled, glass);
        glass.inside = 1.0F;
        glass.transmission = 0.7F;
        addAll(cases, kSamplePrincipled, glass);
    }
    MaterialCase m = plainMaterial(0.4F);
    m.anisotropy = 0.8F;
    m.clearcoat = 0.7F;
    m.clearcoatRoughness = 0.2F;
    addAll(cases, kSamplePrincipled, m);
    m.clearcoatRoughness = 0.0F;  // a delta lobe over a continuous one
    m.film = 1.0F;
    addAll(cases, kSamplePrincipled, m);
    m.sheenColor = {0.9F, 0.6F, 0.3F};
    m.sheenRoughness = 0.3F;
    m.metallic = 0.5F;
    addAll(cases, kSamplePrincipled, m);
    m.diffuseTransmission = 0.5F;
    addAll(cases, kSamplePrincipled, m);
    m.transmission = 0.5F;
    addAll(cases, kSamplePrincipled, m);
    m.coatNormal = directionAt(0.97, 2.0);
    m.clearcoatRoughness = 0.5F;
    addAll(cases, kSamplePrincipled, m);
    return cases;
}

TEST(BsdfSamplingTest, MixturesFollowTheirDensity)
{
    const Summary summary = checkSampling("principled", mixtures(), 1 << 12);
    EXPECT_LE(summary.largestWeight, 1.0 / 0.02);  // the least probability of a lobe
    EXPECT_LE(summary.weights[summary.weights.size() / 2], 2.0F);
}

// What a rather smooth metal scatters more than once goes along the surface: (1 - E(wi)) / (1 - mean E) is 100 and more there. Sampled by
// the cosine, weights were 65.
TEST(BsdfSamplingTest, MetalsSeenAlongTheSurfaceHaveSmallWeights)
{
    std::vector<BsdfCase> cases;
    for (const float roughness : {0.04F, 0.1F, 0.2F, 0.5F, 1.0F}) {
        for (const double cosine : {0.001, 0.01, 0.1, 1.0}) {
            cases.push_back({directionAt(cosine, kAzimuth), kSamplePrincipled, 0, plainMaterial(roughness, 1.0F)});
        }
    }
    float largest = 0.0F;
    for (const SampledDirection& s : Sampled(cases).sample(kPointsHashed, 1 << 16, kFeaturePrincipled)) {
        largest = std::max({largest, s.weight.x, s.weight.y, s.weight.z});
    }
    std::cout << "  largest weight " << largest << "\n";
    EXPECT_LT(largest, 4.0F);
}

// Paths meet glass many times: the second moment of a weight bounds how their variance grows from one to the next.
TEST(BsdfSamplingTest, GlassHasSmallWeights)
{
    constexpr uint kCount = 1 << 14;
    std::vector<BsdfCase> cases;
    for (const float roughness : {0.1F, 0.25F, 0.5F, 0.75F, 1.0F}) {
        for (const float ior : {1.1F, 1.5F, 2.4F}) {
            for (const float inside : {0.0F, 1.0F}) {
                for (const double cosine : {0.02, 0.2, 0.5, 0.8, 1.0}) {
                    MaterialCase m = plainMaterial(roughness);
                    m.base = vec3(1.0F);
                    m.transmission = m.solid = 1.0F;
                    m.inside = inside;
                    m.ior = ior;
                    cases.push_back({directionAt(cosine, kAzimuth), kSamplePrincipled, 0, m});
                }
            }
        }
    }
    const auto samples = Sampled(cases).sample(kPointsHashed, kCount, getFeatures(cases));
    double largest = 0.0, moment = 0.0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const MaterialCase& m = cases[i].material;
        double squares = 0.0;
        for (const SampledDirection& s : std::span(samples).subspan(i * kCount, kCount)) {
            const double eta = s.wi.z < 0.0F ? etaOf(m) : 1.0, weight = static_cast<double>(s.weight.x) * eta * eta;
            squares += weight * weight / kCount;
            largest = std::max(largest, weight);
        }
        moment = std::max(moment, squares);
    }
    EXPECT_LT(largest, 4.0);
    EXPECT_LT(moment, 1.6);
    std::cout << "  largest weight " << largest << ", largest second moment " << moment << "\n";
}

// A layer of factor 0 leaves the bits that a kernel without it computes.
TEST(BsdfSamplingTest, AbsentLayersLeaveNoTrace)
{
    std::vector<BsdfCase> cases;
    for (const float roughness : kRoughnesses) {
        for (const float metallic : {0.0F, 0.4F, 1.0F}) {
            MaterialCase m = plainMaterial(roughness, metallic);
            m.clearcoatRoughness = 0.3F;
            m.sheenRoughness = 0.3F;
            addAll(cases, kSamplePrincipled, m);
        }
    }
    const Sampled sampled(cases);
    const std::vector<SampledDirection> with = sampled.sample(kPointsHashed, 1 << 9, kAllFeatures);
    const std::vector<SampledDirection> without = sampled.sample(kPointsHashed, 1 << 9, kFeaturePrincipled);
    std::size_t different = 0;
    for (std::size_t i = 0; i < with.size(); ++i) {
        different += std::memcmp(&with[i], &without[i], sizeof(SampledDirection)) != 0 ? 1 : 0;
    }
    EXPECT_EQ(different, 0U) << "of " << with.size();
}

// Grazing directions, alpha about kMinAlpha, the ends of the unit interval: the kernel asks that all numbers are finite.
TEST(BsdfSamplingTest, H20CornersAreFinite)
{
    const float least = std::sqrt(1e-3F);
    std::vector<BsdfCase> cases;
    for (BsdfCase c : mixtures()) {
        for (const float roughness : {0.0F, least * 0.999F, least, least * 1.001F, 0.3F, 1.0F}) {
            for (const double cosine : {1e-7, 1e-6, 1e-4, 1.0}) {
                c.material.roughness = roughness;
                c.material.clearcoatRoughness = c.material.clearcoatRoughness > 0.0F ? roughness : 0.0F;
                c.wo = directionAt(cosine, kAzimuth);
                cases.push_back(c);
            }
        }
    }
    Sampled(cases).sample(kPointsCorners, 64, kAllFeatures);
}

}  // namespace glim::bsdf_sampling_test
