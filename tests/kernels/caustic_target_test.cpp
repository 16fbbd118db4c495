// Cones of directions towards the targets of light paths: against the spheres themselves, in double.
#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim::caustic_target_test {

using glm::dvec3;

constexpr double kPi = std::numbers::pi;

// As in shaders/lib/caustic_target.glsl.
enum Profile : uint { kAround, kInFront, kFromBoth, kSpot, kProfiles };

struct Emitter {
    vec3 p;
    uint profile;
    vec3 axis;
    float inner, outer;
};

struct Case {
    glm::vec4 target;
    Emitter emitter;
    vec2 u;
    vec3 probe;
};

struct Result {
    vec3 axis;
    float solidAngle, importance;
    uint around;
    vec3 w;
    uint holdsProbe;
};

std::vector<Result> run(const std::vector<Case>& cases)
{
    KernelTest test(test_kernels::caustic_target_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

double angleBetween(const dvec3& a, const dvec3& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

// The target as the emitter sees it.
struct Seen {
    dvec3 towards;
    double distance, radius;
    double half;  // angle that the sphere's edge makes with its middle
    bool inside() const { return distance <= radius; }
};

Seen seen(const Case& c)
{
    const dvec3 towards = dvec3(c.target) - dvec3(c.emitter.p);
    const double distance = glm::length(towards), radius = static_cast<double>(c.target.w);
    return {towards, distance, radius, std::asin(std::min(1.0, radius / distance))};
}

// How far the cosine's rounding moves the cone's rim where the emitter almost touches the sphere, and that of a direction elsewhere.
double rimError(double half) { return 3e-7 * (1.0 + std::tan(std::min(half, 1.57))); }

// Intensity at an angle from the axis, its maximum being 1. A spot's is the squared ramp of KHR_lights_punctual.
double intensityAt(const Emitter& emitter, double angle)
{
    switch (emitter.profile) {
    case kAround: return 1.0;
    case kInFront: return std::max(0.0, std::cos(angle));
    case kFromBoth: return std::abs(std::cos(angle));
    default: break;
    }
    const double versine = 2.0 * std::pow(std::sin(0.5 * angle), 2.0), outer = static_cast<double>(emitter.outer);
    return std::pow(std::clamp((outer - versine) / (outer - static_cast<double>(emitter.inner)), 0.0, 1.0), 2.0);
}

// Radii of 1e-4 to nearly 1 of the distance, and emitters within. A probe is near the rim.
Case anyCase(Random& random, uint profile)
{
    const double radius = random.logUniform(1e-2, 10.0), apart = random.uniform();
    const double distance = apart < 0.2   ? radius * random.uniform()
                            : apart < 0.4 ? radius * random.uniform(1.0, 1.1)
                                          : radius * random.logUniform(1.0, 1e4);
    Case c{};
    const dvec3 center = random.normalVector();
    c.target = glm::vec4(vec3(center), static_cast<float>(radius));
    const double outer = random.logUniform(1e-3, 1.0);
    const double inner = outer * random.uniform();
    c.emitter = {vec3(center + distance * random.direction()), profile, vec3(random.direction()), static_cast<float>(inner),
                 static_cast<float>(outer)};
    c.u = {random.unitFloat(), random.unitFloat()};
    const Seen s = seen(c);
    const dvec3 across = glm::normalize(glm::cross(s.towards, random.direction()));
    const double angle = s.half * random.uniform(0.0, 2.0);
    c.probe = glm::normalize(std::cos(angle) * s.towards / s.distance + std::sin(angle) * across);
    return c;
}

std::vector<Case> anyCases(std::uint64_t seed)
{
    Random random(seed);
    std::vector<Case> cases;
    for (uint i = 0; i < 200000; ++i) {
        cases.push_back(anyCase(random, i % kProfiles));
    }
    return cases;
}

TEST(CausticTargetTest, ConesAreThoseOfTheSpheres)
{
    const std::vector<Case> cases = anyCases(71);
    const std::vector<Result> results = run(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Case& c = cases[i];
        const Result& r = results[i];
        const Seen s = seen(c);
        // Where rounding decides on which side of the sphere the emitter is.
        if (std::abs(s.distance - s.radius) <= 1e-6 * s.radius) {
            continue;
        }
        ASSERT_EQ(r.around != 0, s.inside()) << "case " << i;
        if (s.inside()) {
            EXPECT_NEAR(static_cast<double>(r.solidAngle), c.emitter.profile == kInFront ? 2.0 * kPi : 4.0 * kPi, 2e-6);
            EXPECT_EQ(r.importance, r.solidAngle) << "case " << i;
            EXPECT_EQ(r.holdsProbe, 1U) << "case " << i;
            EXPECT_TRUE(c.emitter.profile != kInFront || glm::dot(dvec3(r.w), dvec3(c.emitter.axis)) >= -3e-7) << "case " << i;
            continue;
        }
        EXPECT_LE(angleBetween(dvec3(r.axis), s.towards), 3e-7) << "case " << i;
        const double solidAngle = 4.0 * kPi * std::pow(std::sin(0.5 * s.half), 2.0);
        EXPECT_NEAR(static_cast<double>(r.solidAngle), solidAngle, solidAngle * 2.0 * rimError(s.half) / std::min(s.half, 0.3))
            << "case " << i;
        EXPECT_LE(angleBetween(dvec3(r.w), s.towards), s.half + rimError(s.half)) << "case " << i << ": a sample beside the sphere";
        const double beyond = angleBetween(dvec3(c.probe), s.towards) - s.half;
        EXPECT_TRUE(std::abs(beyond) <= 2.0 * rimError(s.half) || (r.holdsProbe != 0) == (beyond < 0.0))
            << "case " << i << ": " << beyond << " beyond a rim at " << s.half;
    }
}

// The least importance that bounds what the emitter sends into the cone: that of the direction in it next to the axis.
TEST(CausticTargetTest, ImportanceIsTheBrightestDirectionTimesTheSolidAngle)
{
    const std::vector<Case> cases = anyCases(72);
    const std::vector<Result> results = run(cases);
    constexpr double kVersineSlack = 2e-6;  // kSlack and the rounding of a cosine
    std::size_t dark = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Case& c = cases[i];
        const Seen s = seen(c);
        if (s.distance <= (1.0 + 1e-6) * s.radius) {
            continue;
        }
        double angle = angleBetween(dvec3(c.emitter.axis), s.towards);
        angle = c.emitter.profile == kFromBoth ? std::min(angle, kPi - angle) : angle;
        const double nearest = std::max(0.0, angle - s.half), versine = 1.0 - std::cos(nearest),
                     error = rimError(s.half) * std::sin(nearest);
        const double least = intensityAt(c.emitter, std::acos(std::max(-1.0, 1.0 - versine - error)));
        const double most = intensityAt(c.emitter, std::acos(std::min(1.0, 1.0 - versine + error + kVersineSlack)));
        const double found = static_cast<double>(results[i].importance) / static_cast<double>(results[i].solidAngle);
        EXPECT_GE(found, least - 1e-6) << "case " << i;
        EXPECT_LE(found, most + 1e-6) << "case " << i;
        const double sent = intensityAt(c.emitter, angleBetween(dvec3(c.emitter.axis), dvec3(results[i].w)));
        EXPECT_LE(sent, found + 1e-6) << "case " << i << ": a sample is brighter";
        dark += found == 0.0 ? 1 : 0;
    }
    EXPECT_GT(dark, cases.size() / 20) << "or there is little to test";
}

TEST(CausticTargetTest, TheUnitOfLengthDoesNotMatter)
{
    std::vector<Case> cases = anyCases(73);
    const std::vector<Result> results = run(cases);
    for (const float scale : {0x1p-13F, 0x1p13F}) {
        std::vector<Case> scaled = cases;
        for (Case& c : scaled) {
            c.target *= scale;
            c.emitter.p *= scale;
        }
        const std::vector<Result> others = run(scaled);
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const Result &a = results[i], &b = others[i];
            EXPECT_TRUE(a.axis == b.axis && a.solidAngle == b.solidAngle && a.importance == b.importance && a.around == b.around &&
                        a.w == b.w && a.holdsProbe == b.holdsProbe)
                << "case " << i << " times " << scale;
        }
    }
}

// Counts directions in rings of equal solid angle about `pole`, down to `whole` = 1 - cos, and in sectors.
void expectUniform(const std::string& what, const Case& at, const dvec3& pole, double whole, std::uint64_t seed)
{
    constexpr int kRings = 10, kSectors = 20;
    Random random(seed);
    std::vector<Case> cases(400000, at);
    for (Case& c : cases) {
        c.u = {random.unitFloat(), random.unitFloat()};
    }
    const dvec3 x = glm::normalize(glm::cross(pole, dvec3(0.3, 0.9, -0.2))), y = glm::cross(pole, x);
    std::vector<double> counts(kRings * kSectors, 0.0);
    for (const Result& r : run(cases)) {
        const dvec3 w(r.w);
        const double rise = 2.0 * std::pow(std::sin(0.5 * angleBetween(w, pole)), 2.0) / whole;
        const double turn = 0.5 + std::atan2(glm::dot(w, y), glm::dot(w, x)) / (2.0 * kPi);
        ++counts[static_cast<std::size_t>(std::min(kRings - 1, static_cast<int>(rise * kRings)) * kSectors +
                                          std::min(kSectors - 1, static_cast<int>(turn * kSectors)))];
    }
    expectCounts(what, counts, std::vector<double>(counts.size(), static_cast<double>(cases.size()) / kRings / kSectors), 7);
}

TEST(CausticTargetTest, SamplesAreUniform)
{
    const dvec3 axis = glm::normalize(dvec3(0.2, -0.7, 0.4));
    const auto at = [&axis](double distance, uint profile) {
        return Case{glm::vec4(0.5F, 1.0F, -2.0F, 1.0F),
                    {vec3(dvec3(0.5, 1.0, -2.0) + distance * glm::normalize(dvec3(3, 1, 2))), profile, vec3(axis), 0.1F, 0.5F},
                    {},
                    {0, 0, 1}};
    };
    for (const double distance : {1.0001, 2.5, 300.0}) {
        const Case c = at(distance, kAround);
        const Seen s = seen(c);
        expectUniform("cone at " + std::to_string(distance), c, s.towards / s.distance, 1.0 - std::cos(s.half),
                      static_cast<std::uint64_t>(distance));
    }
    for (const uint profile : {kAround, kInFront, kFromBoth, kSpot}) {
        expectUniform("within, profile " + std::to_string(profile), at(0.5, profile), axis, profile == kInFront ? 1.0 : 2.0, 74 + profile);
    }
}

// Radii and distances of 0: the answer is finite and no NaN, and a target without extent has no importance.
TEST(CausticTargetTest, DegenerateTargetsAreNotAimedAt)
{
    std::vector<Case> cases;
    for (const float radius : {0.0F, 1e-30F, 1.0F}) {
        for (const float distance : {0.0F, 1e-3F, 1.0F, 1e6F}) {
            for (uint profile = 0; profile < kProfiles; ++profile) {
                cases.push_back({{0, 0, distance, radius}, {vec3(0.0F), profile, {0, 0, 1}, 0.1F, 0.5F}, {0.3F, 0.6F}, {1, 0, 0}});
            }
        }
    }
    const std::vector<Result> results = run(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Result& r = results[i];
        const bool inside = seen(cases[i]).inside();
        EXPECT_EQ(r.around != 0, inside) << "case " << i;
        EXPECT_TRUE(r.solidAngle >= 0.0F && r.solidAngle <= 12.6F && r.importance >= 0.0F && r.importance <= r.solidAngle) << "case " << i;
        EXPECT_TRUE(inside || cases[i].target.w >= 1.0F || r.importance == 0.0F) << "case " << i;
        EXPECT_TRUE(inside || r.holdsProbe == 0) << "case " << i;
    }
}

}  // namespace glim::caustic_target_test
