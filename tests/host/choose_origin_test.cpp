#include "host/scene/choose_origin.hpp"

#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>

namespace glim {
namespace {

using Places = std::vector<Place>;

// `count` primitives of about this size in a ball.
void add(Places& places, std::size_t count, const glm::dvec3& center, double radius, double size, std::uint32_t part, Random& random)
{
    for (std::size_t i = 0; i < count; ++i) {
        places.push_back(
            {center + radius * std::cbrt(random.uniform()) * random.direction(), size * random.logUniform(0.3, 3.0), 1.0, part});
    }
}

// On a sphere.
void addShell(Places& places, std::size_t count, const glm::dvec3& center, double radius, double size, std::uint32_t part, Random& random)
{
    for (std::size_t i = 0; i < count; ++i) {
        places.push_back({center + radius * random.direction(), size, 1.0, part});
    }
}

glm::dvec3 boxCenter(const Places& places)
{
    glm::dvec3 low(1e30), high(-1e30);
    for (const Place& place : places) {
        low = glm::min(low, place.center - 0.5 * place.size);
        high = glm::max(high, place.center + 0.5 * place.size);
    }
    return 0.5 * (low + high);
}

glm::dvec3 plainMedian(const Places& places)
{
    glm::dvec3 median;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        for (const Place& place : places) {
            values.push_back(place.center[axis]);
        }
        std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
        median[axis] = values[values.size() / 2];
    }
    return median;
}

// Steps of float32 at the worst of part 0, in sizes of its primitives.
double coarseness(const Places& places, const glm::dvec3& origin)
{
    double worst = 0.0;
    for (const Place& place : places) {
        const glm::dvec3 from = glm::abs(place.center - origin);
        const double spacing = std::ldexp(1.0, std::ilogb(std::max({from.x, from.y, from.z}) + 0.5 * place.size) - 23);
        worst = place.part == 0 ? std::max(worst, spacing / place.size) : worst;
    }
    return worst;
}

struct Input {
    const char* name;
    std::function<void(Places&, Random&)> make;  // of which part 0 is to be held
};

void PrintTo(const Input& input, std::ostream* out) { *out << input.name; }

class ChooseOriginTest : public testing::TestWithParam<Input> {};

TEST_P(ChooseOriginTest, H52OriginIsNearTheDetail)
{
    Random random(7);
    Places places;
    GetParam().make(places, random);
    const double ours = coarseness(places, chooseOrigin(places, boxCenter(places))), box = coarseness(places, boxCenter(places));
    const double median = coarseness(places, plainMedian(places));
    printHardCase("H52", GetParam().name, static_cast<double>(places.size()), "steps of " + figure(ours) + " of a primitive's size",
                  "box's centre: " + figure(box) + ", plain median: " + figure(median));
    EXPECT_LT(ours, 1e-3);
    EXPECT_LE(ours, 8.0 * std::min(box, median));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ChooseOriginTest,
                         testing::Values(Input{"a millimetre alone",
                                               [](Places& p, Random& r) {
                                                   add(p, 2000, {1e3, 0, 0}, 1e-3, 3e-5, 0, r);
                                               }},
                                         Input{"1e7 m alone", [](Places& p, Random& r) { add(p, 2000, glm::dvec3(0), 1e7, 3e5, 0, r); }},
                                         Input{"a model and a stray card at 1e7 m",
                                               [](Places& p, Random& r) {
                                                   add(p, 2000, glm::dvec3(0), 0.1, 0.01, 0, r);
                                                   add(p, 2, {1e7, 0, 0}, 1.0, 1.0, 1, r);
                                               }},
                                         Input{"a model and strays of 1e-9 m at 1e6 m",
                                               [](Places& p, Random& r) {
                                                   add(p, 2000, glm::dvec3(0), 0.1, 0.01, 0, r);
                                                   add(p, 10, {0, 1e6, 0}, 1.0, 1e-9, 1, r);
                                               }},
                                         Input{"a model and another of almost as many at 1e6 m",
                                               [](Places& p, Random& r) {
                                                   add(p, 2000, glm::dvec3(0), 0.1, 0.01, 0, r);
                                                   add(p, 1900, {1e6, 0, 0}, 0.1, 0.01, 1, r);
                                               }},
                                         Input{"a room of 24 triangles and a stray one of 1e-6 m at 1e6 m",
                                               [](Places& p, Random& r) {
                                                   add(p, 24, glm::dvec3(0), 3.0, 1.0, 0, r);
                                                   add(p, 1, {0, 1e6, 0}, 1.0, 1e-6, 1, r);
                                               }},
                                         Input{"a room of 60 triangles and a sun of 1,280 at 1.5e8 m",
                                               [](Places& p, Random& r) {
                                                   add(p, 60, glm::dvec3(0), 3.0, 1.0, 0, r);
                                                   addShell(p, 1280, {1e8, 1e8, 3e7}, 7e5, 1e5, 1, r);
                                               }},
                                         Input{"a model of 500 triangles off the centre of a dome of 1e5 m",
                                               [](Places& p, Random& r) {
                                                   add(p, 500, {3e4, -2e4, 1e4}, 0.5, 0.02, 0, r);
                                                   addShell(p, 10000, glm::dvec3(0), 1e5, 3e3, 1, r);
                                               }},
                                         Input{"a watch 30 km from the middle of a terrain of 1e5 m",
                                               [](Places& p, Random& r) {
                                                   add(p, 20000, {3e4, 20, 1e3}, 0.02, 3e-4, 0, r);
                                                   add(p, 200000, glm::dvec3(0), 5e4, 100.0, 1, r);
                                               }},
                                         Input{"a million boxes of a city, 1e4 m wide",
                                               [](Places& p, Random& r) {
                                                   add(p, 1000000, {5e6, 0, 5e6}, 1e4, 10.0, 0, r);
                                               }}),
                         [](const testing::TestParamInfo<Input>& parameter) { return "Scene" + std::to_string(parameter.index); });

TEST(ChooseOriginGridTest, MovesWithTheScene)
{
    Random random(3);
    Places here;
    add(here, 200, glm::dvec3(0), 1.0, 0.1, 0, random);
    for (const double far : {1e4, 1e6, 1e9}) {
        Places there = here;
        for (Place& place : there) {
            place.center += glm::dvec3(far, -far, far);
        }
        const glm::dvec3 center(100.0), step(far, -far, far);  // as if a part lay astray
        EXPECT_NE(chooseOrigin(here, center), center);
        EXPECT_EQ(chooseOrigin(there, center + step) - chooseOrigin(here, center), step) << far;
        EXPECT_EQ(chooseOrigin(here, glm::dvec3(0.25)), glm::dvec3(0.25)) << "as good as the median";
    }
}

// Two balls as detailed as each other: one of them must be coarse.
TEST(FindCoarsePartsTest, NamesThemWithTheirSteps)
{
    Random random(5);
    Places places;
    add(places, 300, glm::dvec3(0), 0.1, 0.01, 4, random);
    add(places, 200, {1e6, 0, 0}, 0.1, 0.01, 7, random);
    add(places, 200, {1e7, 0, 0}, 0.1, 0.01, 8, random);
    add(places, 2, {1e5, 0, 0}, 0.1, 100.0, 9, random);
    const std::vector<CoarsePart> coarse = findCoarseParts(places, glm::dvec3(0));
    ASSERT_EQ(coarse.size(), 2U);
    EXPECT_EQ(coarse[0].part, 8U);
    EXPECT_EQ(coarse[0].spacing, 1.0);
    EXPECT_EQ(coarse[1].part, 7U);
    EXPECT_EQ(coarse[1].spacing, 0x1p-4);
}

}  // namespace
}  // namespace glim
