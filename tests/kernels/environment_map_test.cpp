#include "host/flatten/environment_map.hpp"

#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

namespace glim::environment_map_test {

constexpr double kPi = std::numbers::pi;

struct Case {
    uvec2 u;
    vec3 w;
};

struct Result {
    vec3 w;
    float pdf, pdfAgain;
    vec3 radiance, radianceAtW;
    float pdfAtW;
};

RadianceMap mapOf(std::uint32_t width, std::uint32_t height, const glm::vec3& color)
{
    RadianceMap map;
    map.width = width;
    map.height = height;
    map.texels.assign(std::size_t{width} * height, color);
    return map;
}

// Lognormal texels of three channels, a tenth of them black.
RadianceMap randomMap(std::uint32_t width, std::uint32_t height, double sigma, std::uint64_t seed)
{
    Random random(seed);
    RadianceMap map = mapOf(width, height, vec3(0.0F));
    for (glm::vec3& texel : map.texels) {
        for (int c = 0; c < 3; ++c) {
            texel[c] = static_cast<float>(std::exp(sigma * random.normal()));
        }
        texel *= random.below(10) == 0 ? 0.0F : 1.0F;
    }
    return map;
}

glm::dvec3 toMap(const glm::dvec3& w, double rotation)
{
    const double c = std::cos(rotation), s = std::sin(rotation);
    return {c * w.x - s * w.z, w.y, s * w.x + c * w.z};
}

glm::dvec2 placeOf(const glm::dvec3& w) { return {0.5 + std::atan2(w.x, -w.z) / (2.0 * kPi), std::atan2(std::hypot(w.x, w.z), w.y) / kPi}; }

// Of the map's own texels, in double.
glm::dvec3 radianceOf(const RadianceMap& map, const glm::dvec2& at)
{
    const double x = at.x * map.width - 0.5, y = at.y * map.height - 0.5, left = std::floor(x), top = std::floor(y);
    const auto texel = [&map](double i, double j) {
        const double n = map.width;
        const auto column = static_cast<std::size_t>(i - n * std::floor(i / n));
        return glm::dvec3(map.texels[static_cast<std::size_t>(std::clamp(j, 0.0, map.height - 1.0)) * map.width + column]);
    };
    const double s = x - left, t = y - top;
    return (1.0 - t) * ((1.0 - s) * texel(left, top) + s * texel(left + 1.0, top)) +
           t * ((1.0 - s) * texel(left, top + 1.0) + s * texel(left + 1.0, top + 1.0));
}

// A map on the device, looked up and sampled.
class MapOnDevice {
public:
    explicit MapOnDevice(const RadianceMap& radiance, float rotation = 0.0F)
        : map(packEnvironmentMap(std::make_shared<RadianceMap>(radiance))),
          turn_(std::cos(rotation), std::sin(rotation))
    {
        texels_.emplace(testDevice(), "test's map", BufferKind::Texel8, map.texels.size() * sizeof(uvec2));
        upload(*texels_, std::span<const uvec2>(map.texels));
        cells_.emplace(testDevice(), "test's cells", BufferKind::Texel, map.cells.size() * sizeof(uvec4));
        upload(*cells_, std::span<const uvec4>(map.cells));
    }

    std::vector<Result> results(const std::vector<Case>& cases) const
    {
        KernelTest test(test_kernels::environment_map_test);
        test.parameters().environment = vec3(1.0F);
        test.parameters().environmentSize = map.size;
        test.parameters().environmentCells = map.cellCount;
        test.parameters().environmentRotation = turn_;
        test.buffers({{kBindEnvironment, &*texels_}, {kBindEnvironmentCells, &*cells_}});
        test.cases(cases).resultsOf<Result>(cases.size()).run();
        return test.results<Result>();
    }

    std::uint32_t rows() const { return map.cellCount.y; }
    std::uint32_t columns() const { return map.cellCount.x; }
    double pdfOfCell(std::size_t cell) const { return static_cast<double>(std::bit_cast<float>(map.cells[cell].z)); }
    // Exact: 2 pi (cos a - cos b) per row.
    double solidAngle(std::uint32_t row) const
    {
        const double a = kPi * row / rows(), b = kPi * (row + 1.0) / rows();
        return 4.0 * kPi / columns() * std::sin(0.5 * (a + b)) * std::sin(0.5 * (b - a));
    }

    PackedEnvironment map;

private:
    vec2 turn_;
    std::optional<Buffer> texels_, cells_;
};

std::vector<Case> randomCases(std::size_t count, std::uint64_t seed)
{
    Random random(seed);
    std::vector<Case> cases(count);
    for (Case& c : cases) {
        c = {{random.bits(), random.bits()}, random.direction()};
    }
    return cases;
}

double sumOfProbabilities(const MapOnDevice& map)
{
    double sum = 0.0;
    for (std::uint32_t row = 0; row < map.rows(); ++row) {
        for (std::uint32_t x = 0; x < map.columns(); ++x) {
            sum += map.pdfOfCell(std::size_t{row} * map.columns() + x) * map.solidAngle(row);
        }
    }
    return sum;
}

// Thresholds: tests/README.md.
void expectIntegral(const std::string& name, const std::vector<double>& estimates, double truth, std::size_t tests)
{
    const double n = static_cast<double>(estimates.size()), mean = std::accumulate(estimates.begin(), estimates.end(), 0.0) / n;
    const double squares = std::accumulate(estimates.begin(), estimates.end(), 0.0,
                                           [mean](double sum, double value) { return sum + (value - mean) * (value - mean); });
    const double error = std::sqrt(squares / (n - 1.0) / n);
    std::printf("  %s: integral %.7g +- %.1g, truth %.7g\n", name.c_str(), mean, error, truth);
    EXPECT_LE(std::abs(mean - truth), scoreLimit(tests) * error + 2e-5 * truth) << name;
}

// The integral over the sphere of what interpolation makes of one texel of row y whose radiance is 1.
double integralOfTexel(const RadianceMap& map, std::uint32_t y)
{
    constexpr int kFine = 256;
    double sum = 0.0;
    for (int j = -kFine; j < 2 * kFine; ++j) {
        const double v = y + (j + 0.5) / kFine;
        if (v > 0.0 && v < map.height) {
            const double row = std::clamp(v, 0.5, map.height - 0.5);  // beyond the outermost centre it stays the same
            sum += std::max(0.0, 1.0 - std::abs(row - (y + 0.5))) * std::sin(kPi * v / map.height);
        }
    }
    return sum / kFine * kPi / map.height * 2.0 * kPi / map.width;
}

struct Agreement {
    double atEdges = 0.0;   // share of samples that are in another cell when their density is computed again
    double radiance = 0.0;  // largest error of a look-up, over the strongest texel
};

// What must hold of any map. `tests`: how many statistical comparisons the caller makes in all.
Agreement expectConsistent(const std::string& name, const RadianceMap& radiance, float rotation, const std::vector<Case>& cases,
                           std::size_t tests)
{
    const MapOnDevice map(radiance, rotation);
    EXPECT_NEAR(sumOfProbabilities(map), 1.0, 1e-6) << name;
    const std::vector<Result> results = map.results(cases);
    float strongest = 0.0F;
    for (const glm::vec3& texel : radiance.texels) {
        strongest = std::max({strongest, texel.r, texel.g, texel.b});
    }
    Agreement agreement;
    const std::uint32_t rows = std::min(map.rows(), 64U), columns = std::min(map.columns(), 64U);
    std::vector<double> counts(std::size_t{rows} * columns), expected(counts.size()), estimates;
    for (std::size_t i = 0; i < results.size(); ++i) {
        const Result& r = results[i];
        const glm::dvec2 at = placeOf(toMap(glm::dvec3(r.w), static_cast<double>(rotation)));
        // Cells share their edges: there rounding decides.
        const double x = at.x * map.columns(), y = at.y * map.rows();
        const double edge = std::min(std::abs(x - std::round(x)), std::abs(y - std::round(y)));
        // Next to a pole a direction of float32 has a longitude of little precision.
        const double sine = std::max(std::hypot(static_cast<double>(r.w.x), static_cast<double>(r.w.z)), 1e-12);
        const bool atEdge = edge < 4e-7 * std::max(map.columns() / std::min(sine, 1.0), 1.0 * map.rows());
        EXPECT_TRUE(atEdge || r.pdf == r.pdfAgain) << name << ", sample " << i << ": " << r.pdf << " and " << r.pdfAgain;
        agreement.atEdges += r.pdf != r.pdfAgain ? 1.0 / static_cast<double>(results.size()) : 0.0;
        const glm::dvec3 error = glm::abs(glm::dvec3(r.radianceAtW) -
                                          radianceOf(radiance, placeOf(toMap(glm::dvec3(cases[i].w), static_cast<double>(rotation)))));
        agreement.radiance = std::max({agreement.radiance, error.r / static_cast<double>(strongest),
                                       error.g / static_cast<double>(strongest), error.b / static_cast<double>(strongest)});
        EXPECT_TRUE(r.radianceAtW == vec3(0.0F) || r.pdfAtW > 0.0F) << name;
        ++counts[std::min(static_cast<std::size_t>(at.y * rows), std::size_t{rows} - 1) * columns +
                 std::min(static_cast<std::size_t>(at.x * columns), std::size_t{columns} - 1)];
        estimates.push_back(static_cast<double>(r.radiance.g) / static_cast<double>(r.pdf));
    }
    if (counts.size() > 1 && map.rows() % rows == 0 && map.columns() % columns == 0) {
        for (std::uint32_t y = 0; y < map.rows(); ++y) {
            for (std::uint32_t x = 0; x < map.columns(); ++x) {
                expected[std::size_t{y / (map.rows() / rows)} * columns + x / (map.columns() / columns)] +=
                    static_cast<double>(cases.size()) * map.pdfOfCell(std::size_t{y} * map.columns() + x) * map.solidAngle(y);
            }
        }
        expectCounts(name, counts, expected, tests);
    }
    // The integral of the bilinear map over the sphere, by the midpoint rule on a finer grid.
    constexpr int kFine = 8;
    double truth = 0.0;
    for (std::uint32_t j = 0; j < kFine * radiance.height; ++j) {
        const double a = kPi * j / (kFine * radiance.height), b = kPi * (j + 1.0) / (kFine * radiance.height);
        const double angle = 4.0 * kPi / (kFine * radiance.width) * std::sin(0.5 * (a + b)) * std::sin(0.5 * (b - a));
        for (std::uint32_t i = 0; i < kFine * radiance.width; ++i) {
            truth += angle * radianceOf(radiance, {(i + 0.5) / (kFine * radiance.width), (j + 0.5) / (kFine * radiance.height)}).g;
        }
    }
    expectIntegral(name, estimates, truth, tests);
    return agreement;
}

TEST(EnvironmentMapTest, H15SamplesAsItsTableSays)
{
    const std::tuple<const char*, RadianceMap, float> maps[] = {{"dark and bright texels, 64 x 32", randomMap(64, 32, 2.0, 1), 0.0F},
                                                                {"the same, turned", randomMap(64, 32, 2.0, 1), 2.5F},
                                                                {"37 x 19", randomMap(37, 19, 1.0, 2), -1.0F},
                                                                {"constant, 16 x 8", mapOf(16, 8, vec3(2.0F)), 0.0F},
                                                                {"one texel", mapOf(1, 1, vec3(2.0F)), 0.0F},
                                                                {"a row", randomMap(8, 1, 1.0, 3), 0.0F},
                                                                {"a column", randomMap(1, 8, 1.0, 4), 0.0F}};
    const std::size_t tests = 2 * std::size(maps) * static_cast<std::size_t>(testRounds());
    Agreement most;
    for (int round = 0; round < testRounds(); ++round) {
        const std::vector<Case> cases = randomCases(100000, 20 + static_cast<std::uint64_t>(round));
        for (const auto& [name, map, rotation] : maps) {
            const Agreement found = expectConsistent(name, map, rotation, cases, tests);
            most.atEdges = std::max(most.atEdges, found.atEdges);
            // Texels are packed to 2^-18 of their strongest channel; places are rounded, and radiance changes by all of it over a texel.
            EXPECT_LE(found.radiance, 0x1p-18 + 4.0 * 1.5e-7 * map.width) << name;
            most.radiance = std::max(most.radiance, found.radiance);
        }
    }
    printHardCase("H15", "seven maps, 1 x 1 to 64 x 32", 7e5,
                  "pdfs differ for " + figure(most.atEdges) + ", at edges of cells only; radiance within " + figure(most.radiance));
}

// Light from one texel at each pole: every sample that follows the light is in it, and its direction is finite.
TEST(EnvironmentMapTest, H15HotTexelsAtThePoles)
{
    RadianceMap map = mapOf(2048, 1024, vec3(0.0F));
    map.texels[700] = vec3(1e4F);
    map.texels[map.texels.size() - 300] = vec3(2e4F);
    const MapOnDevice device(map, 0.3F);
    EXPECT_NEAR(sumOfProbabilities(device), 1.0, 1e-6);
    const std::vector<Case> cases = randomCases(200000, 7);
    const std::vector<Result> results = device.results(cases);
    double away = 0.0, unequal = 0.0;
    std::vector<double> estimates;
    for (const Result& r : results) {
        const double fromPole = std::hypot(static_cast<double>(r.w.x), static_cast<double>(r.w.z));
        away += fromPole > 3.0 * kPi / 1024.0 ? 1.0 : 0.0;
        unequal += r.pdf != r.pdfAgain ? 1.0 : 0.0;
        estimates.push_back(static_cast<double>(r.radiance.g) / static_cast<double>(r.pdf));
    }
    const double n = static_cast<double>(results.size());
    expectIntegral("hot texels at the poles", estimates, 1e4 * integralOfTexel(map, 0) + 2e4 * integralOfTexel(map, 1023), 2);
    EXPECT_LT(away / n, 0.01);
    EXPECT_LT(unequal / n, 1e-3);
    printHardCase("H15", "one hot texel at each pole, 2,048 x 1,024", n,
                  figure(away / n) + " of the samples elsewhere; pdfs differ for " + figure(unequal / n));
}

// More than 2^23 texels: blocks of two by two make a cell.
TEST(EnvironmentMapTest, CellsOfSeveralTexels)
{
    RadianceMap map = mapOf(5000, 2000, vec3(0.01F));
    map.texels[std::size_t{1000} * 5000 + 4999] = vec3(1e5F);
    map.texels[2500] = vec3(1e6F);
    const MapOnDevice device(map);
    EXPECT_EQ(device.map.cellCount, uvec2(2500, 1000));
    EXPECT_NEAR(sumOfProbabilities(device), 1.0, 1e-6);
    std::vector<double> estimates;
    for (const Result& r : device.results(randomCases(100000, 8))) {
        estimates.push_back(static_cast<double>(r.radiance.g) / static_cast<double>(r.pdf));
    }
    const double suns = 1e5 * integralOfTexel(map, 1000) + 1e6 * integralOfTexel(map, 0);
    expectIntegral("cells of four texels", estimates, 0.01 * 4.0 * kPi + suns, 2);
}

TEST(EnvironmentMapTest, ABlackMapIsNone)
{
    const PackedEnvironment map = packEnvironmentMap(std::make_shared<RadianceMap>(mapOf(4, 2, vec3(0.0F))));
    EXPECT_EQ(map.integral, 0.0);
    EXPECT_TRUE(map.texels.empty() && map.cells.empty());
}

}  // namespace glim::environment_map_test
