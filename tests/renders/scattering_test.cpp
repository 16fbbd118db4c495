// Volumes that scatter: closed objects in a furnace, slabs against adding and doubling (tests/oracle/slab.py), and what is cut or not
// reached.
#include "host/flatten/flatten_scene.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/oracle_cases.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glim {
namespace {

using glm::vec3;

// Glass that holds a medium. Of index 1 it has no boundary.
Material makeVolume(const vec3& extinction, const vec3& albedo, float anisotropy, float ior)
{
    Material m;
    m.metallic = m.roughness = 0.0F;
    m.transmission = 1.0F;
    m.solid = true;
    m.ior = ior;
    m.scattering = extinction * albedo;
    m.absorption = extinction - m.scattering;
    m.scatterAnisotropy = anisotropy;
    return m;
}

Triangles box(const vec3& low, const vec3& high)
{
    const auto corner = [&](int i) {
        return vec3((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z);
    };
    Triangles mesh;
    for (const auto& f : {std::array{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
        mesh.push_back({{corner(f[0]), corner(f[1]), corner(f[2])}});
        mesh.push_back({{corner(f[0]), corner(f[2]), corner(f[3])}});
    }
    return mesh;
}

// A ring of radius .7 and thickness .3.
Triangles torus()
{
    constexpr int kAround = 24, kAcross = 12;
    const auto point = [](int i, int j) {
        const float a = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i % kAround) / kAround;
        const float b = 2.0F * std::numbers::pi_v<float> * static_cast<float>(j % kAcross) / kAcross;
        const float r = 0.7F + 0.3F * std::cos(b);
        return vec3(r * std::cos(a), r * std::sin(a), 0.3F * std::sin(b));
    };
    Triangles mesh;
    for (int i = 0; i < kAround; ++i) {
        for (int j = 0; j < kAcross; ++j) {
            mesh.push_back({{point(i, j), point(i + 1, j), point(i + 1, j + 1)}});
            mesh.push_back({{point(i, j), point(i + 1, j + 1), point(i, j + 1)}});
        }
    }
    return mesh;
}

// One of four shapes of one material in a white sky, which fills the picture.
Scene furnaceOf(const std::string& shape, const Material& material)
{
    SceneBuilder builder;
    builder.add(material);
    builder.environment(vec3(1.0F)).perspective({1, 2, 4}, {0, 0, 0}, 0.35F);
    if (shape == "ball") {
        builder.sphere({0, 0, 0}, 1.0F, 0);
    }
    Scene scene = builder.scene();
    const Triangles round = icosphere(2);
    if (shape == "mesh") {
        addMesh(scene, round, 0, listVertices(round));
    } else if (shape == "cube") {
        addMesh(scene, box(vec3(-0.7F), vec3(0.7F)), 0);
    } else if (shape == "torus") {
        addMesh(scene, torus(), 0);
    }
    return scene;
}

struct Volume {
    vec3 extinction;
    float anisotropy, ior;
};

// The same with a boundary that transmits diffusely and reflects nothing of its own.
Material makeMilky(const vec3& extinction, float ior)
{
    Material m = makeVolume(extinction, vec3(1.0F), 0.0F, ior);
    m.transmission = m.specular = 0.0F;
    m.diffuseTransmission = m.roughness = 1.0F;
    return m;
}

class ScatteringFurnaceTest : public testing::TestWithParam<const char*> {};

// White media send back all the light, whatever their shape, boundary, density and anisotropy. The last medium differs from channel to
// channel.
TEST_P(ScatteringFurnaceTest, LosesNoLight)
{
    const std::string shape = GetParam();
    const vec3 grey(6.0F), colored(0.5F, 3.0F, 20.0F);
    for (const auto& [extinction, anisotropy, ior] :
         {Volume{grey, 0.0F, 1.4F}, {colored, -0.5F, 1.4F}, {grey, 0.8F, 1.0F}, {colored, 0.8F, 1.0F}}) {
        const Scene scene = furnaceOf(shape, makeVolume(extinction, vec3(1.0F), anisotropy, ior));
        expectMean(shape + " of index " + std::to_string(ior) + " and anisotropy " + std::to_string(anisotropy),
                   renderScene(scene, squareSettings(16, samplesFor(64))), glm::dvec3(1.0));
    }
    expectMean("milky " + shape, renderScene(furnaceOf(shape, makeMilky(grey, 1.4F)), squareSettings(16, samplesFor(64))), glm::dvec3(1.0));
}

INSTANTIATE_TEST_SUITE_P(Shapes, ScatteringFurnaceTest, testing::Values("ball", "cube", "torus"));

// Smooth normals, here up to 10 degrees off their faces, refract some light to the wrong side of its face, and after a walk it does not
// pass back by the same face: .0028 of it is lost.
TEST(ScatteringTest, SmoothNormalsLoseLittleLight)
{
    const Scene scene = furnaceOf("mesh", makeVolume(vec3(6.0F), vec3(1.0F), 0.0F, 1.4F));
    const MeanEstimate estimate = meanOf(renderScene(scene, squareSettings(16, samplesFor(64))));
    EXPECT_GE(estimate.mean.x, 0.995 - 5.0 * estimate.standardError.x);
    EXPECT_LE(estimate.mean.x, 1.0 + 5.0 * estimate.standardError.x);
}

// What is cut is counted: a white medium so dense that some walks are too long. All light that leaves it is that of the sky.
TEST(ScatteringTest, CutWalksAreCounted)
{
    const Scene scene = furnaceOf("ball", makeVolume(vec3(1e4F), vec3(1.0F), 0.0F, 1.0F));
    const FlatScene flat = flattened(scene);
    for (const Schedule schedule : {Schedule::Wavefront, Schedule::Persistent}) {
        RenderSettings settings = squareSettings(8, 32);
        settings.schedule = schedule;
        Renderer renderer(testDevice(), flat, flattenCamera(scene.cameras[0], 1.0F), settings);
        const Film film = renderer.render([](const RenderProgress&) { return true; });
        const RenderStatistics& statistics = renderer.statistics();
        EXPECT_GE(statistics.scatteringCaps, 1U);
        EXPECT_NEAR(statistics.cutThroughput, statistics.scatteringCaps, 1e-3 * statistics.scatteringCaps);
        EXPECT_NEAR(meanOf(film).mean.x + statistics.cutThroughput / (8.0 * 8.0 * 32.0), 1.0, 1e-4);
    }
}

// Light of a bulb gets in through a boundary that is rough or transmits diffusely: as much as of a small ball that rays can hit.
TEST(ScatteringTest, PointLightsReachVolumesThroughOpenBoundaries)
{
    constexpr float kRadius = 0.05F, kIntensity = 4.0F, kRadiance = kIntensity / (std::numbers::pi_v<float> * kRadius * kRadius);
    Material rough = makeVolume({6.0F, 3.0F, 1.0F}, {0.9F, 0.8F, 0.99F}, 0.3F, 1.4F), diffuse = rough;
    rough.roughness = 0.8F;
    diffuse.transmission = 0.0F;
    diffuse.diffuseTransmission = diffuse.roughness = 1.0F;
    for (const Material& material : {rough, diffuse}) {
        SceneBuilder bulb, ball;
        PunctualLight light;
        light.position = {1.0F, 2.0F, 1.0F};
        light.intensity = vec3(kIntensity);
        bulb.sphere({0, 0, 0}, 1.0F, bulb.add(material)).light(light).perspective({0, 0, 5}, {0, 0, 0}, 0.3F);
        ball.sphere({0, 0, 0}, 1.0F, ball.add(material));
        ball.sphere(light.position, kRadius, ball.lambert(vec3(0.0F), vec3(kRadiance))).perspective({0, 0, 5}, {0, 0, 0}, 0.3F);
        expectSameMean(material.transmission > 0.0F ? "rough boundary" : "diffuse boundary",
                       renderScene(bulb.scene(), squareSettings(16, samplesFor(256))),
                       renderSeeds(ball.scene(), squareSettings(16, samplesFor(256)), 2)[1]);
    }
}

struct SlabCase {
    float albedo, depth, anisotropy, cosine, reflected, transmitted;
};

// However dense, a thick body has its colour: within 1 % too where positions in float do not resolve free paths.
TEST(ScatteringTest, DenseBodiesLookAlike)
{
    const auto estimateOf = [](float extinction, std::uint32_t seed) {
        RenderSettings settings = squareSettings(16, samplesFor(256));
        settings.seed = seed;
        return meanOf(renderScene(furnaceOf("cube", makeVolume(vec3(extinction), vec3(0.99F), 0.0F, 1.0F)), settings));
    };
    const MeanEstimate thick = estimateOf(1e3F, 0);
    for (const float extinction : {1e8F, 1e30F}) {
        const MeanEstimate dense = estimateOf(extinction, 1);
        const double error = std::hypot(dense.standardError.x, thick.standardError.x);
        std::printf("extinction %g: %.5f, of 1e3: %.5f, +- %.5f\n", static_cast<double>(extinction), dense.mean.x, thick.mean.x, error);
        EXPECT_NEAR(dense.mean.x, thick.mean.x, 0.01 * thick.mean.x + 4.0 * error);
    }
}

// Within a white volume radiance is that of the sky around it times the index squared.
TEST(ScatteringTest, CamerasMayStandWithinVolumes)
{
    Scene scene = furnaceOf("ball", makeVolume(vec3(3.0F), vec3(1.0F), 0.3F, 1.4F));
    scene.cameras[0].position = {0.1F, 0.2F, 0.3F};
    expectMean("within a white ball", renderScene(scene, squareSettings(16, samplesFor(64))), glm::dvec3(1.96));
}

// Light paths bring a lamp's light that passes a smooth volume unscattered, camera paths what has scattered there: together as much as
// camera paths alone, and neither twice.
TEST(ScatteringTest, LightPathsAndWalksDivideTheLight)
{
    SceneBuilder builder;
    builder.sphere({0.0F, 0.0F, 1.0F}, 0.8F, builder.add(makeVolume(vec3(0.7F, 1.5F, 3.0F), vec3(0.98F), 0.5F, 1.3F)))
        .quad({{{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}}}, builder.lambert(vec3(0.7F)))
        .quad({{{-2, 2, 4}, {2, 2, 4}, {2, -2, 4}, {-2, -2, 4}}}, builder.lambert(vec3(0.0F), vec3(1.0F)))
        .orthographic({2.4F, 0.0F, 2.0F}, {0.4F, 0.0F, 0.0F}, 0.5F);
    RenderSettings settings = squareSettings(16, samplesFor(512));
    const Film both = renderScene(builder.scene(), settings);
    settings.caustics = false;
    settings.seed = 1;
    expectSameMean("light below a volume", both, renderScene(builder.scene(), settings));
}

constexpr float kWide = 1000.0F;

// A mesh over a black floor that shines upwards. Red is the sky's light, green the floor's.
Scene makeLayer(const Triangles& mesh, const Material& of, float cosine)
{
    SceneBuilder builder;
    const float slant = std::sqrt(1.0F - cosine * cosine) / cosine;
    const std::uint32_t material = builder.add(of), floor = builder.lambert(vec3(0.0F), {0.0F, 1.0F, 1.0F});
    builder.quad({{{-kWide, -kWide, -0.01F}, {kWide, -kWide, -0.01F}, {kWide, kWide, -0.01F}, {-kWide, kWide, -0.01F}}}, floor)
        .environment({1.0F, 0.0F, 1.0F})
        .orthographic({2.0F * slant, 0.0F, 3.0F}, {0.0F, 0.0F, 1.0F}, 0.01F);
    Scene scene = builder.scene();
    addMesh(scene, mesh, material);
    return scene;
}

// A slab of thickness 1, a thousand times as wide.
Scene makeSlab(const Material& medium, float cosine)
{
    return makeLayer(box({-kWide, -kWide, 0.0F}, {kWide, kWide, 1.0F}), medium, cosine);
}

// A wall of colour c that scatters all it transmits sends c (1 + g) / 2 onwards and c (1 - g) / 2 back. Half of that strength leaves half
// of the light to pass straight.
TEST(ScatteringTest, ThinWallsDivideTheirLightByAnisotropy)
{
    for (const float strength : {1.0F, 0.5F}) {
        for (const float anisotropy : {-1.0F, 0.0F, 0.6F}) {
            Material wall;
            wall.metallic = wall.specular = wall.roughness = 0.0F;
            wall.transmission = 1.0F;
            wall.scattersThin = true;
            wall.diffuseTransmission = strength;
            wall.diffuseTransmissionColor = vec3(0.8F);
            wall.scatterAnisotropy = anisotropy;
            const Scene scene = makeLayer({{{vec3(-9, -9, 1), vec3(9, -9, 1), vec3(0, 18, 1)}}}, wall, 0.5F);
            const double share = static_cast<double>(strength), scattered = 0.8 * share;
            const double back = 0.5 - 0.5 * static_cast<double>(anisotropy);
            const glm::dvec3 expected(scattered * back, scattered * (1.0 - back) + 1.0 - share, scattered + 1.0 - share);
            expectMean("thin wall of anisotropy " + std::to_string(anisotropy), renderScene(scene, squareSettings(16, samplesFor(64))),
                       expected);
        }
    }
}

TEST(ScatteringTest, SlabsReflectAndTransmitAsByAddingAndDoubling)
{
    for (const SlabCase& c : oracleCases<SlabCase>("slab_cases")) {
        const Scene scene = makeSlab(makeVolume(vec3(c.depth), vec3(c.albedo), c.anisotropy, 1.0F), c.cosine);
        const glm::dvec3 expected(c.reflected, c.transmitted, c.reflected + c.transmitted);
        expectMean("slab of albedo " + std::to_string(c.albedo) + ", depth " + std::to_string(c.depth) + ", anisotropy " +
                       std::to_string(c.anisotropy) + ", seen at a cosine of " + std::to_string(c.cosine),
                   renderScene(scene, squareSettings(16, samplesFor(64))), expected);
    }
}

// Each channel is a slab of its own, though one channel's distances serve all three.
TEST(ScatteringTest, ChannelsAreSlabsOfTheirOwn)
{
    std::vector<SlabCase> cases = oracleCases<SlabCase>("slab_cases");
    std::erase_if(cases, [](const SlabCase& c) { return c.anisotropy != 0.0F || c.cosine != 0.5F; });
    ASSERT_EQ(cases.size(), 2U);
    const vec3 depth(cases[0].depth, cases[1].depth, cases[0].depth), albedo(cases[0].albedo, cases[1].albedo, 0.0F);
    Scene scene = makeSlab(makeVolume(depth, albedo, 0.0F, 1.0F), 0.5F);
    scene.environment->radiance = vec3(1.0F);
    scene.materials[1].emission = {0.0F, 0.0F, 1.0F};
    const double unscattered = std::exp(-2.0 * static_cast<double>(cases[0].depth));
    expectMean("slab of three media", renderScene(scene, squareSettings(16, samplesFor(256))),
               glm::dvec3(cases[0].reflected, cases[1].reflected, unscattered));
}

}  // namespace
}  // namespace glim
