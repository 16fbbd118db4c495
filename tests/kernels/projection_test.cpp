// Film and directions by OpenCV's camera models and by the equirectangular one: against OpenCV itself, and against formulas in double.
#include "host/flatten/flatten_scene.hpp"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <optional>

namespace glim::projection_test {

using glm::dvec2;
using glm::dvec3;
using Model = Projection::Model;

constexpr double kPi = std::numbers::pi;
constexpr double kMaxPixels = 1e-3;  // the most that a place may be off
const dvec2 kSize(1920.0, 1080.0);

struct Case {
    FlatProjection projection;
    vec2 film;
    vec3 direction;
};

struct Result {
    vec3 direction;
    uint isSeen;
    vec3 film;
};

std::vector<Result> run(const std::vector<Case>& cases)
{
    KernelTest test(test_kernels::projection_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

FlatProjection flatten(const Projection& projection)
{
    Camera camera;
    camera.projection = projection;
    return flattenCamera(camera, static_cast<float>(kSize.x / kSize.y)).projection;
}

dvec2 pixelFromFilm(const dvec2& film) { return 0.5 * kSize * dvec2(1.0 + film.x, 1.0 - film.y); }
vec2 filmFromPixel(const dvec2& pixel) { return vec2(2.0 * pixel.x / kSize.x - 1.0, 1.0 - 2.0 * pixel.y / kSize.y); }

// A place in the camera's space by OpenCV's axes (x right, y down, z ahead), and where OpenCV 5.0.0 projects it (projectPoints and
// fisheye::projectPoints). Its pixels count from the middle of the first one.
struct Projected {
    dvec3 place;
    dvec2 pixel;
};

struct Lens {
    const char* name;
    Projection projection;
    std::vector<Projected> points;
};

const Intrinsics kPinhole{{1387.5, 1391.0}, {962.25 + 0.5, 533.75 + 0.5}, kSize};
const Intrinsics kWide{{612.0, 615.5}, {955.5 + 0.5, 541.25 + 0.5}, kSize};

const Lens kLenses[] = {
    {"no distortion",
     {Model::Straight, kPinhole, {}, {}},
     {{{-2.2755, -0.8672, 4.1603}, {203.348899, 243.800910}},
      {{2.1824, 0.3571, 5.4878}, {1514.033957, 624.264614}},
      {{-3.6279, -0.3586, 6.7716}, {218.893740, 460.087557}},
      {{-0.2386, -2.3252, 8.6283}, {923.881202, 158.895950}},
      {{0.9028, -0.8921, 2.9157}, {1391.867245, 108.153711}},
      {{-0.8633, 0.0797, 6.0127}, {763.033550, 552.188089}}}},
    {"four numbers",
     {Model::RadialTangential, kPinhole, {}, {-.28, .09, .0007, -.0004}},
     {{{0.9534, -0.6043, 3.6811}, {1312.226008, 311.421159}},
      {{-0.8372, 0.4771, 1.2722}, {167.521472, 988.165682}},
      {{-1.6271, -0.9008, 6.1143}, {602.244132, 334.058299}},
      {{4.3523, 0.5677, 8.4174}, {1629.445566, 621.280851}},
      {{-0.0856, 0.4894, 2.2611}, {910.377247, 830.963090}},
      {{-3.6302, 0.9599, 5.8558}, {187.184658, 739.550166}}}},
    {"five numbers",
     {Model::RadialTangential, kPinhole, {}, {.12, -.31, -.0011, .0023, .19}},
     {{{-2.0576, 1.4788, 7.723}, {590.002778, 802.042268}},
      {{1.1286, -0.8573, 3.8484}, {1374.831077, 219.679290}},
      {{1.9932, 0.5715, 4.5773}, {1576.123447, 709.704547}},
      {{0.4208, 0.4421, 1.7438}, {1301.127742, 890.079882}},
      {{-0.6069, 1.3189, 6.4366}, {831.005198, 819.963294}},
      {{1.4897, -0.9392, 2.9818}, {1667.087496, 88.425290}}}},
    {"eight numbers",
     {Model::RadialTangential, kPinhole, {}, {-.41, .17, .0004, .0002, -.019, -.09, .022, -.003}},
     {{{3.7883, -1.3757, 7.7327}, {1589.007256, 305.751062}},
      {{0.158, -0.1539, 1.9364}, {1074.994996, 423.664378}},
      {{1.2962, -2.0896, 8.697}, {1163.905313, 207.922385}},
      {{-2.4483, 1.1342, 5.8014}, {414.027494, 788.508565}},
      {{1.8839, 0.3002, 5.6585}, {1408.217839, 605.052566}},
      {{4.8633, -2.0389, 8.7497}, {1656.091251, 242.373256}}}},
    {"equidistant fisheye",
     {Model::Fisheye, kWide, {}, {}},
     {{{14.9908, 15.1415, 8.7045}, {1464.858731, 1058.671513}},
      {{-17.4418, -5.1129, 6.5192}, {235.243443, 328.906069}},
      {{-5.7692, -4.2594, 2.3163}, {335.937954, 81.211401}},
      {{-8.8112, 11.0441, 5.1324}, {488.957652, 1129.365977}},
      {{-14.558, -7.9272, 6.5007}, {312.101436, 188.899556}},
      {{-0.0404, 1.9731, 0.941}, {941.394764, 1234.076854}}}},
    {"fisheye",
     {Model::Fisheye, kWide, {}, {-.021, .0043, -.0039, .0007}},
     {{{7.6414, -5.5953, 7.0799}, {1406.343304, 209.238825}},
      {{2.07, 3.9123, 3.8462}, {1196.803768, 999.922330}},
      {{0.6764, 0.0922, 0.6666}, {1432.931638, 606.700829}},
      {{1.6375, -9.0299, 4.9859}, {1069.965299, -93.572211}},
      {{-0.0648, -5.0446, 2.2445}, {946.689691, -148.544179}},
      {{-0.7856, 1.4789, 6.8007}, {886.266223, 672.328660}}}},
};

TEST(ProjectionTest, PlacesArePixelsByOpenCvAndBack)
{
    for (const Lens& lens : kLenses) {
        SCOPED_TRACE(lens.name);
        std::vector<Case> cases;
        for (const Projected& point : lens.points) {
            const dvec3 direction = glm::normalize(point.place * dvec3(1.0, -1.0, 1.0));
            cases.push_back({flatten(lens.projection), filmFromPixel(point.pixel + 0.5), vec3(direction)});
        }
        const std::vector<Result> results = run(cases);
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const double perRadian = lens.projection.intrinsics->focal.y;
            EXPECT_LE(glm::distance(pixelFromFilm(dvec2(results[i].film)), lens.points[i].pixel + 0.5), kMaxPixels) << i;
            EXPECT_TRUE(results[i].isSeen != 0) << i;
            // A pixel is no more of an angle than where distortion does not compress.
            EXPECT_LE(glm::distance(dvec3(results[i].direction), dvec3(cases[i].direction)) * perRadian, 2.0 * kMaxPixels) << i;
        }
    }
}

// By the formulas, in double. Directions have y up.
dvec2 project(const Projection& p, const dvec3& direction)
{
    const auto& d = p.distortion;
    if (p.model == Model::Equirectangular) {
        const double longitude = std::atan2(direction.x, direction.z);
        const double latitude = std::atan2(direction.y, std::hypot(direction.x, direction.z));
        return kSize * dvec2(0.5 + longitude / (2.0 * kPi), 0.5 - latitude / kPi);
    }
    dvec2 image(direction.x, -direction.y);
    if (p.model == Model::Fisheye) {
        const double sine = glm::length(image), angle = std::atan2(sine, direction.z), s = angle * angle;
        image *= sine > 0.0 ? angle * (1.0 + s * (d[0] + s * (d[1] + s * (d[2] + s * d[3])))) / sine : 1.0;
    } else {
        image /= direction.z;
        const double x = image.x, y = image.y, s = x * x + y * y;
        const double ratio = (1.0 + s * (d[0] + s * (d[1] + s * d[4]))) / (1.0 + s * (d[5] + s * (d[6] + s * d[7])));
        image = {x * ratio + 2.0 * d[2] * x * y + d[3] * (s + 2.0 * x * x), y * ratio + d[2] * (s + 2.0 * y * y) + 2.0 * d[3] * x * y};
    }
    return p.intrinsics->focal * image + p.intrinsics->center;
}

Projection anyProjection(Random& random, Model model)
{
    Projection p{model,
                 Intrinsics{{random.logUniform(400, 4000), 0.0}, kSize * dvec2(random.uniform(0.3, 0.7), random.uniform(0.3, 0.7)), kSize},
                 {},
                 {}};
    p.intrinsics->focal.y = p.intrinsics->focal.x * random.uniform(0.9, 1.1);
    const auto some = [&](double most) { return random.below(3) == 0 ? 0.0 : random.uniform(-most, most); };
    if (model == Model::RadialTangential) {
        p.distortion = {some(0.5), some(0.3), some(2e-3), some(2e-3), some(0.2), some(0.1), some(0.1), some(0.1)};
    } else if (model == Model::Fisheye) {
        p.distortion = {some(0.08), some(0.02), some(0.005), some(0.001)};
    } else {
        p.intrinsics.reset();
    }
    return p;
}

// What is seen projects to the pixel that shows it. Where the distance from the middle no longer grows, nothing is seen.
TEST(ProjectionTest, PixelsOfAGridShowWhatProjectsToThem)
{
    Random random(211);
    for (const Model model : {Model::RadialTangential, Model::Fisheye, Model::Equirectangular}) {
        std::vector<Case> cases;
        std::vector<Projection> projections;
        for (int i = 0; i < 300; ++i) {
            const Projection projection = anyProjection(random, model);
            const FlatProjection flat = flatten(projection);
            for (int y = 0; y <= 12; ++y) {
                for (int x = 0; x <= 16; ++x) {
                    const dvec2 pixel = kSize * (dvec2(x, y) + 0.5 * dvec2(random.uniform(), random.uniform())) / dvec2(16.5, 12.5);
                    cases.push_back({flat, filmFromPixel(pixel), vec3(0, 0, 1)});
                    projections.push_back(projection);
                }
            }
        }
        const std::vector<Result> results = run(cases);
        double worst = 0.0;
        std::size_t seen = 0;
        for (std::size_t i = 0; i < cases.size(); ++i) {
            if (results[i].isSeen == 0) {
                continue;
            }
            ++seen;
            const dvec2 pixel = pixelFromFilm(dvec2(cases[i].film));
            dvec2 off = project(projections[i], dvec3(results[i].direction)) - pixel;
            off.x -= model == Model::Equirectangular ? kSize.x * std::round(off.x / kSize.x) : 0.0;
            worst = std::max(worst, glm::length(off));
        }
        std::cout << "  model " << static_cast<int>(model) << ": " << seen << " of " << cases.size() << " pixels are seen, off by at most "
                  << worst << " pixels\n";
        EXPECT_LE(worst, kMaxPixels);
        EXPECT_GT(seen, cases.size() * 6 / 10);
    }
}

// The smallest tangent, or angle, at which the image is `distance` from the middle; nothing if it never is while it grows.
std::optional<double> invert(const Projection& p, double distance)
{
    const auto imageOf = [&](double x) {
        const dvec3 direction = p.model == Model::Fisheye ? dvec3(std::sin(x), 0.0, std::cos(x)) : dvec3(x, 0.0, 1.0);
        return (project(p, direction).x - p.intrinsics->center.x) / p.intrinsics->focal.x;
    };
    const double most = p.model == Model::Fisheye ? kPi : 20.0;
    double before = 0.0;
    for (double x = 1e-3; x <= most; x += 1e-3) {
        const double now = imageOf(x);
        if (!(now > before)) {
            return std::nullopt;
        }
        if (now >= distance) {
            return x;
        }
        before = now;
    }
    return std::nullopt;
}

TEST(ProjectionTest, TheFieldOfViewEndsWhereDistortionFoldsBack)
{
    Random random(212);
    std::vector<Case> cases;
    std::vector<bool> expected;
    for (const Model model : {Model::RadialTangential, Model::Fisheye}) {
        for (int i = 0; i < 200; ++i) {
            Projection projection = anyProjection(random, model);
            projection.distortion[0] = -random.uniform(0.05, 0.6);
            if (model == Model::RadialTangential) {
                projection.distortion[2] = projection.distortion[3] = 0.0;  // no circle with them
            }
            const FlatProjection flat = flatten(projection);
            for (int k = 0; k < 8; ++k) {
                const double distance = random.uniform(0.2, 1.8), turn = 2.0 * kPi * random.uniform();
                const bool isSeen = invert(projection, distance).has_value();
                if (isSeen != invert(projection, 1.003 * distance).has_value() ||
                    isSeen != invert(projection, 0.997 * distance).has_value()) {
                    continue;  // too close to tell
                }
                const dvec2 pixel =
                    projection.intrinsics->center + projection.intrinsics->focal * distance * dvec2(std::cos(turn), std::sin(turn));
                cases.push_back({flat, filmFromPixel(pixel), vec3(0, 0, 1)});
                expected.push_back(isSeen);
            }
        }
    }
    const std::vector<Result> results = run(cases);
    std::size_t unseen = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        EXPECT_EQ(results[i].isSeen != 0, expected[i]) << i;
        unseen += expected[i] ? 0 : 1;
    }
    EXPECT_GT(unseen, cases.size() / 10);
    EXPECT_LT(unseen, cases.size() * 9 / 10);
}

// The film, which is 2 by 2, per solid angle: light paths weigh what they bring by it.
TEST(ProjectionTest, AreasOfTheFilmAreThoseOfDifferences)
{
    Random random(213);
    for (const Model model : {Model::Straight, Model::RadialTangential, Model::Fisheye, Model::Equirectangular}) {
        std::vector<Case> cases;
        std::vector<double> areas;
        for (int i = 0; i < 4000; ++i) {
            Projection projection = anyProjection(random, model);
            if (model == Model::Straight) {
                projection.intrinsics = kPinhole;
            }
            dvec3 direction = random.direction();
            if (model != Model::Equirectangular) {
                direction = glm::normalize(dvec3(random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), 1.0));
            }
            const dvec3 side = glm::normalize(glm::cross(direction, random.direction())), other = glm::cross(direction, side);
            constexpr double kStep = 1e-5;
            const auto derivative = [&](const dvec3& to) {
                dvec2 step = project(projection, glm::normalize(direction + kStep * to)) -
                             project(projection, glm::normalize(direction - kStep * to));
                step.x -= model == Model::Equirectangular ? kSize.x * std::round(step.x / kSize.x) : 0.0;
                return step / (kStep * kSize);
            };
            const dvec2 a = derivative(side), b = derivative(other);
            const double flat = std::hypot(direction.x, direction.z);
            const double area = std::abs(a.x * b.y - a.y * b.x);
            const FlatProjection flattened = flatten(projection);
            const double reached = model == Model::Fisheye ? std::acos(direction.z) : std::hypot(direction.x, direction.y) / direction.z;
            if (model == Model::Equirectangular ? flat > 1e-2 : reached < 0.98 * static_cast<double>(flattened.end)) {
                cases.push_back({flattened, vec2(0.0F), vec3(direction)});
                areas.push_back(area);
            }
        }
        const std::vector<Result> results = run(cases);
        EXPECT_GT(cases.size(), 2000U);
        for (std::size_t i = 0; i < cases.size(); ++i) {
            EXPECT_NEAR(static_cast<double>(results[i].film.z), areas[i], 2e-4 * areas[i] + 2e-6 * glm::length(areas[i])) << i;
        }
    }
}

TEST(ProjectionTest, WhatIsBeyondTheEndIsNotOnTheFilm)
{
    const Projection barrel{Model::RadialTangential, kPinhole, {}, {-.3}}, fisheye{Model::Fisheye, kWide, {}, {-.1}};
    const double end = 1.0 / std::sqrt(0.9), angle = std::sqrt(1.0 / 0.3);
    EXPECT_NEAR(findEnd(barrel), end, 2e-6);
    EXPECT_NEAR(findEnd(fisheye), angle, 4e-6);
    std::vector<Case> cases;
    for (const double share : {0.99, 1.01}) {
        const double t = share * end, a = share * angle;
        cases.push_back({flatten(barrel), vec2(0.0F), vec3(glm::normalize(dvec3(t, 0.0, 1.0)))});
        cases.push_back({flatten(fisheye), vec2(0.0F), vec3(0.0, std::sin(a), std::cos(a))});
    }
    const std::vector<Result> results = run(cases);
    EXPECT_GT(results[0].film.z, 0.0F);
    EXPECT_GT(results[1].film.z, 0.0F);
    EXPECT_EQ(results[2].film.z, 0.0F);
    EXPECT_EQ(results[3].film.z, 0.0F);
}

TEST(ProjectionTest, TheEquirectangularMiddleIsAheadAndItsEdgeBehind)
{
    const FlatProjection all = flatten({Model::Equirectangular, {}, {}, {}});
    const std::vector<Result> results = run({{all, {0, 0}, {0, 0, 1}},
                                             {all, {0.5, 0}, {1, 0, 0}},
                                             {all, {1, 0}, {0, 0, -1}},
                                             {all, {0, 1}, {0, 1, 0}},
                                             {all, {0, -1}, {0, -1, 0}}});
    const vec3 expected[] = {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0, -1, 0}};
    for (std::size_t i = 0; i < results.size(); ++i) {
        EXPECT_LE(glm::distance(results[i].direction, expected[i]), 1e-6F) << i;
        EXPECT_TRUE(std::isfinite(results[i].film.z)) << i;
    }
    EXPECT_EQ(results[1].film.x, 0.5F);
}

}  // namespace glim::projection_test
