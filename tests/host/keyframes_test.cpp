// Keyframes against numbers on paper.
#include "host/scene/keyframes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim::test {
namespace {

constexpr double kTolerance = 1e-15;
const double kHalf = std::sqrt(0.5);

void expectValue(const std::vector<double>& value, const std::vector<double>& expected)
{
    ASSERT_EQ(value.size(), expected.size());
    for (std::size_t i = 0; i < value.size(); ++i) {
        EXPECT_NEAR(value[i], expected[i], kTolerance) << "number " << i;
    }
}

TEST(Keyframes, StepsKeepTheValueUntilTheNextTime)
{
    const Keyframes keyframes{Interpolation::Step, false, 2, {1.0, 2.0, 4.0}, {10, 11, 20, 21, 30, 31}};
    expectValue(valueAt(keyframes, 1.0), {10, 11});
    expectValue(valueAt(keyframes, 1.999), {10, 11});
    expectValue(valueAt(keyframes, 2.0), {20, 21});
    expectValue(valueAt(keyframes, 4.0), {30, 31});
}

TEST(Keyframes, LinearValuesAreMixed)
{
    const Keyframes keyframes{Interpolation::Linear, false, 2, {1.0, 3.0}, {10, -2, 20, 2}};
    expectValue(valueAt(keyframes, 1.5), {12.5, -1});
}

TEST(Keyframes, OutsideTheTimesTheFirstAndTheLastValueHold)
{
    const std::vector<double> spline{9, 10, 9, 9, 20, 9};
    for (const Interpolation interpolation : {Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline}) {
        const bool cubic = interpolation == Interpolation::CubicSpline;
        const Keyframes keyframes{interpolation, false, 1, {1.0, 3.0}, cubic ? spline : std::vector<double>{10, 20}};
        expectValue(valueAt(keyframes, 0.0), {10});
        expectValue(valueAt(keyframes, 1.0), {10});
        expectValue(valueAt(keyframes, 3.0), {20});
        expectValue(valueAt(keyframes, 1e9), {20});
    }
    expectValue(valueAt({Interpolation::Linear, false, 1, {5.0}, {7}}, 6.0), {7});
}

// At the middle of 2 s from 0 to 10, leaving at 1/s and arriving at 3/s: 10/2 + 2 (1 - 3)/8. The tangents before the first and behind
// the second key do not count.
TEST(Keyframes, CubicSplinesFollowTheirTangents)
{
    const Keyframes keyframes{Interpolation::CubicSpline, false, 1, {1.0, 3.0}, {100, 0, 1, 3, 10, 100}};
    expectValue(valueAt(keyframes, 2.0), {4.5});
    // A quarter: (3/16 - 1/32) 10 + 2 (9/64) 1 + 2 (1/64 - 1/16) 3.
    expectValue(valueAt(keyframes, 1.5), {1.5625 + 0.28125 - 0.28125});
}

TEST(Keyframes, RotationsTurnAtEqualSpeed)
{
    // From 0 to 90 degrees about z: 22.5 degrees after a quarter.
    const Keyframes keyframes{Interpolation::Linear, true, 4, {0.0, 1.0}, {0, 0, 0, 1, 0, 0, kHalf, kHalf}};
    const double angle = std::acos(-1.0) / 16.0;
    expectValue(valueAt(keyframes, 0.25), {0, 0, std::sin(angle), std::cos(angle)});
}

TEST(Keyframes, RotationsTakeTheShorterWay)
{
    const Keyframes keyframes{Interpolation::Linear, true, 4, {0.0, 1.0}, {0, 0, 0, 1, 0, 0, -kHalf, -kHalf}};
    const std::vector<double> middle = valueAt(keyframes, 0.5);
    const double angle = std::acos(-1.0) / 8.0;
    expectValue(middle, {0, 0, std::sin(angle), std::cos(angle)});
}

TEST(Keyframes, RotationsHaveUnitLength)
{
    // Without tangents the middle is the mean, (0, 0, 0.5, 0.5).
    const Keyframes spline{
        Interpolation::CubicSpline, true, 4, {0.0, 1.0}, {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}};
    expectValue(valueAt(spline, 0.5), {0, 0, kHalf, kHalf});
    // Keys in bytes have some other length.
    const Keyframes bytes{Interpolation::Linear, true, 4, {0.0, 1.0}, {0, 0, 0, 0.9, 0, 0, 0.8, 0.8}};
    const double angle = std::acos(-1.0) / 8.0;
    expectValue(valueAt(bytes, 0.5), {0, 0, std::sin(angle), std::cos(angle)});
    expectValue(valueAt(bytes, 2.0), {0, 0, kHalf, kHalf});
    expectValue(valueAt({Interpolation::Step, true, 4, {0.0}, {0, 0, 0, 0}}, 0.0), {0, 0, 0, 0});
}

}  // namespace
}  // namespace glim::test
