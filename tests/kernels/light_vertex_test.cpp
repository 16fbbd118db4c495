// Vertices of light paths: what they bring to a pixel, by the pixel's size on the surface, and how they scatter on.
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/named.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace glim::light_vertex_test {

using glm::dvec2;
using glm::dvec3;

constexpr double kPi = std::numbers::pi;
constexpr uint kWidth = 64, kHeight = 48, kLightPaths = 308, kMaxBounces = 6;
constexpr std::size_t kFamily = 20;
const dvec3 kAlbedo(0.9, 0.6, 0.3), kThroughput(0.5, 1.0, 2.0);

struct Case {
    PathRay ray;
    PathState state;
};

struct Result {
    uint hasSplat;
    uint pixel;
    ShadowRay cameraRay;
    uint hasNextRay;
    PathRay ray;
    PathState state;
};

struct View {
    Camera camera;
    Lens lens;
    FlatCamera flat() const { return flattenCamera(camera, static_cast<float>(kWidth) / kHeight, lens); }
};

View viewOf(bool orthographic, float lensRadius)
{
    SceneBuilder builder;
    const vec3 from(1.0F, 3.0F, 2.0F), at(0.3F, 0.0F, -0.2F);
    orthographic ? builder.orthographic(from, at, 1.2F) : builder.perspective(from, at, 0.7F);
    return {builder.scene().cameras.front(), {lensRadius, 2.5F}};
}

std::vector<Result> shade(const Scene& scene, const std::vector<Case>& cases, const View& view = viewOf(false, 0.0F),
                          uint minPathLength = 0)
{
    const SceneOnDevice onDevice(scene);
    const Buffer note(testDevice(), "test's note", BufferKind::Storage, sizeof(PathNote));
    KernelTest test = onDevice.test(test_kernels::light_vertex_test);
    test.buffers({{kBindNote, &note}}).specialize(kSpecLens, view.lens.radius > 0.0F ? 1 : 0);
    RenderParameters& parameters = test.parameters();
    parameters.camera = view.flat();
    parameters.width = kWidth;
    parameters.height = kHeight;
    parameters.lightPaths = kLightPaths;
    parameters.minPathLength = minPathLength;
    parameters.maxPathLength = parameters.maxBounces = kMaxBounces;
    parameters.firstMedium = onDevice.flat.firstMedium;
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

Case makeCase(const dvec3& origin, const dvec3& direction, uint bounce)
{
    return {{vec3(origin), kNoPrimitive, vec3(glm::normalize(direction)), 0}, {vec3(kThroughput), 0.0F, 0.0F, 1.0F, bounce, 0}};
}

// Down onto the plane y = 0, where |x| and |z| are below 2.
Case downwards(Random& random, uint bounce)
{
    const dvec3 to(random.uniform(-2.0, 2.0), 0.0, random.uniform(-2.0, 2.0));
    dvec3 back = random.direction();
    back.y = std::abs(back.y) + 0.1;
    return makeCase(to + glm::normalize(back), -back, bounce);
}

dvec3 pointOf(const PathRay& ray)
{
    const dvec3 origin(ray.origin), direction(ray.direction);
    return origin - direction * (origin.y / direction.y);
}

SceneBuilder floorOf(const vec3& albedo)
{
    SceneBuilder builder;
    builder.quad({vec3(-50, 0, 50), {50, 0, 50}, {50, 0, -50}, {-50, 0, -50}}, builder.lambert(albedo));
    return builder;
}

// One triangle of the plane y = 0 that covers |x|, |z| < 2, with one normal at all its vertices.
Scene tiltedFloor(const Material& material, const dvec3& normal)
{
    Scene scene;
    scene.materials.push_back(material);
    addMesh(scene, {{{vec3(-10, 0, 10), {10, 0, 10}, {0, 0, -10}}}}, 0, std::vector<vec3>(3, vec3(normal)));
    return scene;
}

const dvec3 kUp(0, 1, 0), kTilted = glm::normalize(dvec3(0.4, 1.0, -0.3));

Material matte() { return floorOf(vec3(kAlbedo)).scene().materials.front(); }

Material glass()
{
    SceneBuilder builder;
    builder.glass(1.5F);
    return builder.scene().materials.front();
}

// Where the picture shows p, in film coordinates, through the point of the lens whose ray was traced: in space, as scene_types.h says.
dvec2 makeFilm(const FlatCamera& camera, const dvec3& p, const dvec3& aperture)
{
    const dvec3 position(camera.position), right(camera.right), up(camera.up), forward(camera.forward);
    const double inverse = static_cast<double>(camera.inverseFocus), depth = glm::dot(p - position, forward);
    dvec3 across = p - position - depth * forward - aperture * (1.0 - depth * inverse);
    across /= camera.kind == kOrthographic ? 1.0 : depth;
    return {glm::dot(across, right) / glm::dot(right, right), glm::dot(across, up) / glm::dot(up, up)};
}

// The lens point of a ray to the camera, which starts at `from` and ends on the lens.
dvec3 apertureOf(const FlatCamera& camera, const dvec3& from, const dvec3& towards)
{
    const dvec3 forward(camera.forward);
    if (camera.kind == kPerspective) {
        return from + towards - dvec3(camera.position);
    }
    const double inverse = static_cast<double>(camera.inverseFocus);
    return inverse == 0.0 ? dvec3(0.0) : (forward - towards / glm::dot(towards, forward)) / inverse;
}

// Share of the film that one square metre of the floor covers at p: the film is 2 by 2.
double filmPerArea(const FlatCamera& camera, const dvec3& p, const dvec3& aperture)
{
    constexpr double kStep = 1e-4;
    const auto side = [&](const dvec3& step) {
        return (makeFilm(camera, p + step, aperture) - makeFilm(camera, p - step, aperture)) / (2.0 * kStep);
    };
    const dvec2 x = side({kStep, 0, 0}), z = side({0, 0, kStep});
    return std::abs(x.x * z.y - x.y * z.x) / 4.0;
}

class LightVertexCameraTest : public testing::TestWithParam<test::Named<View>> {};

// Flux W on a floor is radiance albedo / pi times W per area; one of `lightPaths` paths gives its pixel W / lightPaths times the pixels
// that the film has per area of the floor.
TEST_P(LightVertexCameraTest, ASplatIsTheFluxOverThePixelsArea)
{
    const View& view = GetParam().value;
    const FlatCamera camera = view.flat();
    Random random(91);
    std::vector<Case> cases;
    for (int i = 0; i < 4000; ++i) {
        cases.push_back(downwards(random, 1));
    }
    const std::vector<Result> results = shade(floorOf(vec3(kAlbedo)).scene(), cases, view);
    std::size_t seen = 0, unseen = 0;
    double farthest = 0.0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Result& r = results[i];
        const dvec3 p = pointOf(cases[i].ray), from(r.cameraRay.origin), towards(r.cameraRay.direction);
        EXPECT_LT(glm::distance(from, p), 1e-4);
        const dvec3 aperture = apertureOf(camera, from, towards);
        EXPECT_LE(glm::length(aperture), static_cast<double>(view.lens.radius) + 1e-4);
        farthest = std::max(farthest, glm::length(aperture));
        const dvec2 film = makeFilm(camera, p, aperture), pixel = dvec2(0.5 * (film.x + 1.0) * kWidth, 0.5 * (1.0 - film.y) * kHeight);
        const dvec2 edge = glm::abs(pixel - glm::round(pixel));
        if (std::min(edge.x, edge.y) < 1e-3) {
            continue;  // rounding decides
        }
        const bool inside = pixel.x > 0.0 && pixel.y > 0.0 && pixel.x < kWidth && pixel.y < kHeight;
        ASSERT_EQ(r.hasSplat != 0, inside) << "case " << i << " at " << pixel.x << ", " << pixel.y;
        seen += inside ? 1 : 0;
        unseen += inside ? 0 : 1;
        if (inside) {
            EXPECT_EQ(r.pixel, static_cast<uint>(pixel.y) * kWidth + static_cast<uint>(pixel.x)) << "case " << i;
            const dvec3 truth = kThroughput * kAlbedo / kPi * (filmPerArea(camera, p, aperture) * kWidth * kHeight / kLightPaths);
            EXPECT_LE(glm::distance(dvec3(r.cameraRay.contribution), truth), 3e-4 * glm::length(truth)) << "case " << i;
            EXPECT_EQ(r.cameraRay.tMax, 1.0F);
            EXPECT_EQ(r.cameraRay.target, kNoPrimitive);
        }
    }
    EXPECT_GT(seen, cases.size() / 10);
    EXPECT_GT(unseen, cases.size() / 10);
    EXPECT_GE(farthest, 0.95 * static_cast<double>(view.lens.radius)) << "or the lens is not used";
}

INSTANTIATE_TEST_SUITE_P(Cameras, LightVertexCameraTest,
                         testing::Values(test::Named{"perspective", viewOf(false, 0.0F)}, test::Named{"orthographic", viewOf(true, 0.0F)},
                                         test::Named{"lens", viewOf(false, 0.2F)}, test::Named{"orthographicLens", viewOf(true, 0.2F)}),
                         test::nameOfParameter);

TEST(LightVertexTest, NothingBehindTheCameraIsSeen)
{
    View view = viewOf(false, 0.0F);
    view.camera.position.y = -0.5F;  // looks down, away from the floor
    Random random(92);
    std::vector<Case> cases;
    for (int i = 0; i < 1000; ++i) {
        cases.push_back(downwards(random, 1));
    }
    for (const Result& r : shade(floorOf(vec3(kAlbedo)).scene(), cases, view)) {
        EXPECT_EQ(r.hasSplat, 0U);
    }
}

// A path that first meets a surface that is not specular is a camera path's. Later ones count from the least length on; the last does not
// go on.
TEST(LightVertexTest, WhichVerticesCount)
{
    std::vector<Case> cases;
    for (uint bounce = 0; bounce < kMaxBounces; ++bounce) {
        cases.push_back(makeCase({0.3, 1.0, -0.2}, {0, -1, 0}, bounce));
        cases.back().state.throughput = vec3(1.0F);
    }
    for (const uint least : {0U, 2U, 4U}) {
        const std::vector<Result> results = shade(floorOf(vec3(1.0F)).scene(), cases, viewOf(false, 0.0F), least);
        for (uint bounce = 0; bounce < kMaxBounces; ++bounce) {
            EXPECT_EQ(results[bounce].hasSplat != 0, bounce > 0 && bounce + 1 >= least) << "bounce " << bounce << ", least " << least;
            EXPECT_EQ(results[bounce].hasNextRay != 0, bounce > 0 && bounce + 1 < kMaxBounces) << bounce;
            EXPECT_EQ(results[bounce].state.bounce, bounce + 1);
        }
    }
}

// Veach 1997, section 5.3: light that arrives from wi along a shading normal ns scatters with |wi.ns| / |wi.ng| of the BSDF times |wo.ng|.
TEST(LightVertexTest, SplatsOfShadingNormalsAreTheAdjoint)
{
    const View view = viewOf(false, 0.0F);
    const FlatCamera camera = view.flat();
    Random random(93);
    std::vector<Case> cases;
    for (int i = 0; i < 2000; ++i) {
        cases.push_back(downwards(random, 1));
    }
    const std::vector<Result> results = shade(tiltedFloor(matte(), kTilted), cases, view);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const dvec3 wi = -dvec3(cases[i].ray.direction), p = pointOf(cases[i].ray);
        const dvec3 wo = glm::normalize(dvec3(camera.position) - p);
        if (results[i].hasSplat == 0 || glm::dot(wi, kTilted) < 0.0 || glm::dot(wo, kTilted) < 0.0) {
            continue;
        }
        const double factor = glm::dot(wi, kTilted) / wi.y;
        const dvec3 truth = kThroughput * kAlbedo / kPi * (factor * filmPerArea(camera, p, dvec3(0.0)) * kWidth * kHeight / kLightPaths);
        EXPECT_LE(glm::distance(dvec3(results[i].cameraRay.contribution), truth), 3e-4 * glm::length(truth)) << "case " << i;
        ++compared;
    }
    EXPECT_GT(compared, cases.size() / 10);
}

// The flux that goes on: roulette included, albedo times what arrives times |wi.ns| / |wi.ng|, and of the half space above the surface that
// part which is above ns too. That is (1 + cos of the angle between the normals) / 2 of a cosine's integral.
void expectFlux(const std::string& name, const dvec3& normal, const dvec3& direction)
{
    std::vector<Case> cases(1U << 18, makeCase(-direction, direction, 3));
    for (Case& c : cases) {
        c.state.throughput *= 0.2F;  // so that roulette ends some
    }
    std::vector<double> flux, upwards;
    for (const Result& r : shade(tiltedFloor(matte(), normal), cases)) {
        const double one = r.hasNextRay != 0 ? static_cast<double>(r.state.throughput.r) : 0.0;
        flux.push_back(one);
        upwards.push_back(one * static_cast<double>(r.ray.direction.y));
    }
    const dvec3 wi = -glm::normalize(direction);
    const double arrives = 0.2 * kThroughput.r * kAlbedo.r * glm::dot(wi, normal) / wi.y;
    expectSampleMean(name, flux, arrives * 0.5 * (1.0 + normal.y), kFamily);
    if (normal == kUp) {
        expectSampleMean(name + ", times its cosine", upwards, arrives * 2.0 / 3.0, kFamily);
    }
}

TEST(LightVertexTest, AMatteSurfaceSendsOnItsAlbedo)
{
    expectFlux("flat", kUp, {0.5, -1.0, 0.2});
    expectFlux("tilted, steep", kTilted, {0.1, -1.0, 0.0});
    expectFlux("tilted, slanted", kTilted, {-1.2, -1.0, 0.7});
}

// Unpolarised, from the index 1 into ior (Fresnel); `cosine` of the direction that arrives.
double fresnel(double cosine, double ior)
{
    const double beyond = std::sqrt(1.0 - (1.0 - cosine * cosine) / (ior * ior));
    const double s = (cosine - ior * beyond) / (cosine + ior * beyond), p = (ior * cosine - beyond) / (ior * cosine + beyond);
    return 0.5 * (s * s + p * p);
}

// Power is split, and none is lost: particles have no refraction's scaling. With a shading normal they weigh
// |wi.ns| |wo.ng| / (|wo.ns| |wi.ng|) (Veach 1997, section 5.3.2).
TEST(LightVertexTest, GlassSplitsThePower)
{
    for (const dvec3& normal : {kUp, kTilted}) {
        const dvec3 direction = glm::normalize(dvec3(-0.4, -1.0, 0.5));
        const std::vector<Case> cases(1U << 17, makeCase(-direction, direction, 0));
        std::vector<double> reflected;
        for (const Result& r : shade(tiltedFloor(glass(), normal), cases)) {
            ASSERT_EQ(r.hasNextRay, 1U);
            ASSERT_EQ(r.hasSplat, 0U);
            const dvec3 wo(r.ray.direction), wi = -direction;
            const double weight = glm::dot(wi, normal) * std::abs(wo.y) / (std::abs(glm::dot(wo, normal)) * wi.y);
            ASSERT_LE(glm::distance(dvec3(r.state.throughput), weight * kThroughput), 3e-6);
            const double sine = std::sqrt(1.0 - std::pow(glm::dot(wi, normal), 2.0));
            const double other = glm::length(glm::cross(wo, normal));
            ASSERT_NEAR(other, wo.y > 0.0 ? sine : sine / 1.5, 1e-6);
            reflected.push_back(wo.y > 0.0 ? 1.0 : 0.0);
        }
        expectSampleMean("reflected", reflected, fresnel(-glm::dot(direction, normal), 1.5), kFamily);
    }
}

// A mirror sends on what it reflects: Schlick's share of white, rising towards grazing directions.
TEST(LightVertexTest, AMirrorReflectsItsColour)
{
    Random random(94);
    std::vector<Case> cases;
    for (int i = 0; i < 2000; ++i) {
        cases.push_back(downwards(random, 0));
    }
    SceneBuilder builder;
    builder.quad({vec3(-50, 0, 50), {50, 0, 50}, {50, 0, -50}, {-50, 0, -50}}, builder.mirror(vec3(kAlbedo)));
    const std::vector<Result> results = shade(builder.scene(), cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Result& r = results[i];
        const dvec3 direction(cases[i].ray.direction);
        ASSERT_EQ(r.hasNextRay, 1U);
        EXPECT_EQ(r.hasSplat, 0U);
        EXPECT_LE(glm::distance(dvec3(r.ray.direction), direction * dvec3(1, -1, 1)), 1e-6);
        const dvec3 share = kAlbedo + (1.0 - kAlbedo) * std::pow(1.0 + direction.y, 5.0);
        EXPECT_LE(glm::distance(dvec3(r.state.throughput), kThroughput * share), 3e-6);
    }
}

// Light that comes from within a solid has been absorbed on its way (Beer and Lambert).
TEST(LightVertexTest, LightWithinASolidIsAbsorbed)
{
    Material material = glass();
    material.absorption = {0.2F, 1.0F, 3.0F};
    const std::array distances{0.1, 0.7, 3.0};
    const dvec3 direction = glm::normalize(dvec3(0.1, -1.0, 0.05));
    std::vector<Case> cases;
    for (const double distance : distances) {
        cases.push_back(makeCase(-distance * direction, direction, 0));
    }
    const vec3 a(-10, 0, 10), b(10, 0, 10), c(0, 0, -10);
    for (const bool within : {true, false}) {
        Scene scene;
        scene.materials.push_back(material);
        addMesh(scene, {within ? Triangle{{a, c, b}} : Triangle{{a, b, c}}});
        for (Case& arriving : cases) {
            arriving.ray.media = within ? 1 : 0;
        }
        const std::vector<Result> results = shade(scene, cases);
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const dvec3 truth = kThroughput * (within ? glm::exp(-distances[i] * dvec3(material.absorption)) : dvec3(1.0));
            EXPECT_LE(glm::distance(dvec3(results[i].state.throughput), truth), 3e-6) << distances[i];
        }
    }
}

}  // namespace glim::light_vertex_test
