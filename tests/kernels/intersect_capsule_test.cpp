// The oracle is the distance to the segment in extended precision. A capsule is convex, so along a line that distance falls and then rises.
#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace glim::intersect_capsule_test {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr double kRounding = 0x1p-24;

struct CapsuleCase {
    vec3 origin, direction, base, axis;
    float radius, tmax;
    std::uint32_t onSurface;
};

using Vector = glm::vec<3, long double>;

Vector awayFromAxis(const CapsuleCase& c, const Vector& p)
{
    const Vector axis(c.axis), from = p - Vector(c.base);
    const long double along = std::clamp(glm::dot(from, axis) / glm::dot(axis, axis), 0.0L, 1.0L);
    return from - along * axis;
}

Vector pointAt(const CapsuleCase& c, long double t) { return Vector(c.origin) + t * Vector(c.direction); }

double depthAt(const CapsuleCase& c, long double t)
{
    return static_cast<double>(static_cast<long double>(c.radius) - glm::length(awayFromAxis(c, pointAt(c, t))));
}

// By trisection, within `reach` of the point of the ray that is closest to the segment's middle.
long double deepest(const CapsuleCase& c, long double reach)
{
    const Vector d(c.direction), middle = Vector(c.base) + 0.5L * Vector(c.axis);
    const long double t = glm::dot(middle - Vector(c.origin), d) / glm::dot(d, d);
    long double low = t - reach, high = t + reach;
    for (int i = 0; i < 120; ++i) {
        const long double a = low + (high - low) / 3.0L, b = high - (high - low) / 3.0L;
        (depthAt(c, a) < depthAt(c, b) ? low : high) = depthAt(c, a) < depthAt(c, b) ? a : b;
    }
    return 0.5L * (low + high);
}

std::vector<float> distances(const std::vector<CapsuleCase>& cases)
{
    KernelTest test(test_kernels::intersect_capsule_test);
    test.cases(cases).resultsOf<float>(cases.size()).run();
    return test.results<float>();
}

struct Shape {
    double length, radius, distance;
};

// From `distance` at a point of the capsule, or a little beside it.
CapsuleCase rayAt(Random& random, const Shape& shape)
{
    const glm::dvec3 base = 3.0 * random.direction(), axis = shape.length * random.direction();
    const glm::dvec3 target = base + random.uniform(-0.05, 1.05) * axis + 1.1 * shape.radius * random.direction();
    CapsuleCase c{target + shape.distance * random.direction(), {}, base, axis, static_cast<float>(shape.radius), kFar, 0};
    c.direction = glm::normalize(target - glm::dvec3(c.origin));
    return c;
}

// What rounding may move the surface by. The way to the ray's origin rounds once, and t once more; behind that every operation is on
// lengths below the capsule's own, some forty of them.
double boundOf(const CapsuleCase& c)
{
    const double way = glm::length(glm::dvec3(c.origin) - glm::dvec3(c.base));
    return kRounding * (4.0 * way + 40.0 * (glm::length(glm::dvec3(c.axis)) + static_cast<double>(c.radius)));
}

// Each ray meets the near side, to within the bound; or nothing, if no point of it is deeper than the bound.
TEST(IntersectCapsuleTest, ThinFarAndLongOnesAreMetWhereTheyAre)
{
    for (const Shape& shape : {Shape{1.0, 0.3, 2.0},
                               {1.0, 1e-3, 1.0},
                               {1.0, 1e-3, 1e3},
                               {1e3, 1e-2, 10.0},
                               {1e-3, 1e-5, 1.0},
                               {1e-3, 1.0, 5.0},
                               {100.0, 1e-3, 1e-2}}) {
        Random random(4);
        std::vector<CapsuleCase> cases(20000);
        std::ranges::generate(cases, [&] { return rayAt(random, shape); });
        const std::vector<float> found = distances(cases);
        double worst = 0.0;
        int met = 0;
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const CapsuleCase& c = cases[i];
            const double bound = boundOf(c);
            if (depthAt(c, 0.0L) > -bound) {
                continue;  // starts within, or as good as
            }
            if (found[i] < 0.0F) {
                const long double t = deepest(c, shape.length + 2.0 * shape.radius);
                ASSERT_LE(t > 0.0L ? depthAt(c, t) : 0.0, bound) << i << " of " << shape.distance;
                continue;
            }
            ++met;
            const auto t = static_cast<long double>(found[i]);
            const Vector out = awayFromAxis(c, pointAt(c, t));
            worst = std::max(worst, std::abs(depthAt(c, t)) / bound);
            ASSERT_LE(std::abs(depthAt(c, t)), bound) << i << " of " << shape.distance;
            // The near side faces the ray, but for a silhouette as wide as the bound.
            const double facing = static_cast<double>(glm::dot(out, Vector(c.direction)) / glm::length(out));
            ASSERT_LE(facing, 2.0 * std::sqrt(2.0 * bound / shape.radius)) << i << " of " << shape.distance;
        }
        EXPECT_GT(met, 5000);
        printHardCase("lines", "length " + figure(shape.length) + ", radius " + figure(shape.radius) + " from " + figure(shape.distance),
                      static_cast<double>(cases.size()), "error at most " + figure(worst) + " of the bound", "");
    }
}

// Of a strip: rays at the place where two capsules meet pass between none.
TEST(IntersectCapsuleTest, RaysAtAJointMeetOneOfTheTwo)
{
    Random random(5);
    std::vector<CapsuleCase> cases;
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 joint = random.direction();
        const Shape shape{1.0, 0.01, 10.0};
        const glm::vec3 origin = joint + shape.distance * random.direction();
        const glm::dvec3 target = joint + 0.99 * shape.radius * random.direction();
        for (int side = 0; side < 2; ++side) {
            const glm::vec3 base(joint);
            cases.push_back({origin, glm::normalize(target - glm::dvec3(origin)), base, random.direction(), 0.01F, kFar, 0});
        }
    }
    const std::vector<float> found = distances(cases);
    for (std::size_t i = 0; i < found.size(); i += 2) {
        ASSERT_TRUE(found[i] > 0.0F || found[i + 1] > 0.0F) << i;
    }
}

// A ray that starts on the capsule meets the far side from within, or nothing.
TEST(IntersectCapsuleTest, LeavesItsOwnSurface)
{
    Random random(6);
    std::vector<CapsuleCase> cases;
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 base = random.direction(), axis = 0.5 * random.direction();
        const glm::dvec3 side = glm::normalize(glm::cross(axis, random.direction()));
        const glm::dvec3 origin = base + random.uniform(0.0, 1.0) * axis + 0.1 * side;
        cases.push_back({origin, random.direction(), base, axis, 0.1F, kFar, 1});
    }
    const std::vector<float> found = distances(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const CapsuleCase& c = cases[i];
        const double outwards = static_cast<double>(glm::dot(awayFromAxis(c, Vector(c.origin)), Vector(c.direction)));
        if (outwards > 1e-6) {
            ASSERT_EQ(found[i], -1.0F) << i;
        } else if (outwards < -1e-3) {
            ASSERT_GT(found[i], 0.0F) << i;
            ASSERT_LE(std::abs(depthAt(c, static_cast<long double>(found[i]))), boundOf(c)) << i;
            // No chord is shorter than that of the ball which touches the start from within.
            ASSERT_GE(static_cast<double>(found[i]), -1.99 * outwards) << i;
        }
    }
}

TEST(IntersectCapsuleTest, SeenFromWithinAlongTheAxisAndBehind)
{
    const vec3 x(1.0F, 0.0F, 0.0F), y(0.0F, 1.0F, 0.0F);
    const std::vector<CapsuleCase> cases = {
        {{1.0F, 0.0F, 0.0F}, y, {}, 2.0F * x, 0.5F, kFar, 0},     // from the axis
        {{-3.0F, 0.0F, 0.0F}, x, {}, 2.0F * x, 0.5F, kFar, 0},    // along it
        {{1.0F, 0.0F, 0.0F}, x, {}, 2.0F * x, 0.5F, kFar, 0},     // from within, to an end
        {{-3.0F, 0.25F, 0.0F}, -x, {}, 2.0F * x, 0.5F, kFar, 0},  // behind
        {{1.0F, 2.0F, 0.0F}, -y, {}, 2.0F * x, 0.5F, 1.0F, 0},    // too far
        {{1.0F, 2.0F, 0.0F}, -y, {}, 2.0F * x, 0.5F, kFar, 0},
        {{-0.125F, 2.0F, 0.0F}, -y, {}, 2.0F * x, 0.125F * std::sqrt(2.0F), kFar, 0},  // the ball of an end
    };
    const std::vector<float> found = distances(cases), expected{0.5F, 2.5F, 1.5F, -1.0F, -1.0F, 1.5F, 1.875F};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        EXPECT_NEAR(found[i], expected[i], found[i] > 0.0F ? boundOf(cases[i]) : 0.0) << i;
    }
}

}  // namespace glim::intersect_capsule_test
