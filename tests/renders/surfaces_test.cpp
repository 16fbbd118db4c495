// Layers of the first surface: places project to the pixels that show them, and flow is what depth and pose say.
#include "host/render/surfaces.hpp"
#include "host/render/seen_instances.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/named.hpp"
#include "tests/support/prepare_in_memory.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>

namespace glim {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr glm::uvec2 kSize(64, 48);

Camera turned(const dvec3& position, double angle)
{
    Camera camera;
    camera.position = position;
    camera.yfov = 0.9F;
    camera.right = dvec3(std::cos(angle), 0, -std::sin(angle));
    camera.forward = dvec3(-std::sin(angle), 0, -std::cos(angle));
    return camera;
}

// Balls that mirror each other, a floor, a sphere and points, far from the world's origin.
Scene yard()
{
    Scene scene = makeTestScene(icosphere(2));
    scene.instances.clear();
    addInstance(scene, 0, {-1.2, 0.2, -1.0}, 0.7, {0.6, 0.8, 0.6});
    addInstance(scene, 0, {1.1, 0.0, -0.5}, 2.1, {-0.5, 0.9, 0.7});
    addMesh(scene, {{{{-4, -1, 4}, {4, -1, 4}, {4, -1, -4}}}, {{{-4, -1, 4}, {4, -1, -4}, {-4, -1, -4}}}});
    Mesh& floor = scene.meshes.change().back();
    floor.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    Mesh cloud;
    cloud.isCloud = true;
    cloud.pointRadius = 0.2;
    cloud.positions = {{-0.3, 0.9, 0.0}, {0.4, 1.1, -0.5}};
    scene.meshes.change().push_back(cloud);
    scene.instances.push_back({"cloud", static_cast<std::uint32_t>(scene.meshes.size() - 1), glm::dmat4(1.0)});
    scene.spheres.push_back({"ball", {0.0F, -0.4F, 0.3F}, 0.4F});
    scene.cameras = {turned({0.2, 0.6, 4.0}, 0.05)};
    scene.origin = {1000.0, -2000.0, 500.0};
    for (MeshInstance& instance : scene.instances) {
        instance.worldFromMesh = glm::translate(glm::dmat4(1.0), scene.origin) * instance.worldFromMesh;
    }
    return nameParts(scene);
}

FlatCamera flatten(const Camera& camera) { return flattenCamera(camera, static_cast<float>(kSize.x) / static_cast<float>(kSize.y)); }

class Tracing {
public:
    Tracing(const PreparedScene& prepared, const Camera& camera, const Flow* flow = nullptr)
        : renderer_(testDevice(), prepared.flat, flatten(camera), settings()),
          instances_(prepared.scene),
          tracer_(renderer_, prepared, flatten(camera), instances_, flow)
    {}
    Image image() { return tracer_.rows(kSize.x, 0, kSize.y); }
    Json objects() { return describeSeenInstances(tracer_, instances_, kSize, "a.exr"); }

private:
    static RenderSettings settings()
    {
        RenderSettings settings = squareSettings(kSize.y, 1);
        settings.width = kSize.x;
        return settings;
    }
    Renderer renderer_;
    SceneInstances instances_;
    SurfaceTracer tracer_;
};

dvec3 positionAt(const Image& image, std::size_t i)
{
    return {image.channels.at("position.X")[i], image.channels.at("position.Y")[i], image.channels.at("position.Z")[i]};
}

dvec2 pairAt(const Image& image, const std::string& layer, const char* letters, std::size_t i)
{
    return {image.channels.at(layer + letters[0])[i], image.channels.at(layer + letters[1])[i]};
}

dvec2 centerOf(std::size_t i) { return {static_cast<double>(i % kSize.x) + 0.5, static_cast<double>(i / kSize.x) + 0.5}; }

// The pixel of a place, by the pinhole of a perspective camera with square pixels and no shift.
dvec2 pinhole(const Camera& camera, const dvec3& from)
{
    const double focal = 0.5 * kSize.y / std::tan(0.5 * static_cast<double>(camera.yfov));
    const double depth = glm::dot(from, dvec3(camera.forward));
    return 0.5 * dvec2(kSize) + focal / depth * dvec2(glm::dot(from, dvec3(camera.right)), -glm::dot(from, dvec3(camera.up)));
}

struct Bent {
    Projection::Model model;
    std::array<double, 8> distortion;
};

const test::Named<Bent> kBentCameras[] = {{"straight", {Projection::Model::Straight, {}}},
                                          {"distorted", {Projection::Model::RadialTangential, {-0.1, 0.02, 0.005, -0.01}}},
                                          {"fisheye", {Projection::Model::Fisheye, {0.03, -0.01}}},
                                          {"equirectangular", {Projection::Model::Equirectangular, {}}}};

class SurfacesOfCameraTest : public testing::TestWithParam<test::Named<Bent>> {};

// Flow between moments that do not differ is nothing: what the device's rays have met is projected to the pixel's centre, by any camera.
TEST_P(SurfacesOfCameraTest, WhatDoesNotMoveHasNoFlow)
{
    const PreparedScene prepared = prepare(yard());
    Camera camera = prepared.scene.cameras.front();
    camera.projection.model = GetParam().value.model;
    camera.projection.distortion = GetParam().value.distortion;
    camera.projection.shift = camera.projection.model == Projection::Model::Equirectangular ? dvec2(0.0) : dvec2(0.05, -0.02);
    const Flow flow{{prepared.scene, flatten(camera)}, {prepared.scene, flatten(camera)}};
    const Image image = Tracing(prepared, camera, &flow).image();
    double worst = 0.0;
    for (std::size_t i = 0; i < std::size_t{kSize.x} * kSize.y; ++i) {
        for (const char* layer : {"forwardFlow.", "backwardFlow."}) {
            const dvec2 step = pairAt(image, layer, "XY", i);
            worst = std::max({worst, std::abs(step.x), std::abs(step.y)});
            ASSERT_TRUE(glm::length(step) < 1e-3) << layer << i << ": " << step.x << ", " << step.y;
        }
    }
    std::printf("  %.2g pixel at most\n", worst);
}

INSTANTIATE_TEST_SUITE_P(Cameras, SurfacesOfCameraTest, testing::ValuesIn(kBentCameras), test::nameOfParameter);

TEST(SurfacesTest, PlacesAreAtTheirDistanceAlongTheRay)
{
    const PreparedScene prepared = prepare(yard());
    const Camera camera = prepared.scene.cameras.front();
    const Image image = Tracing(prepared, camera).image();
    std::map<std::uint32_t, std::size_t> pixels;
    for (std::size_t i = 0; i < std::size_t{kSize.x} * kSize.y; ++i) {
        const std::uint32_t instance = image.counts.at("instance.X")[i];
        const float distance = image.channels.at("distance.Y")[i];
        ++pixels[instance];
        if (instance == kNoIndex) {
            EXPECT_TRUE(std::isinf(distance) && std::isnan(positionAt(image, i).x) && std::isnan(image.channels.at("uv.U")[i]));
            continue;
        }
        const dvec3 from = positionAt(image, i) - (prepared.scene.origin + dvec3(camera.position));
        EXPECT_NEAR(glm::length(from), static_cast<double>(distance), 3e-4) << i;  // positions in float32, 2000 m from the origin
        EXPECT_LE(glm::distance(pinhole(camera, from), centerOf(i)), 5e-3) << i;
        const dvec2 uv = pairAt(image, "uv.", "UV", i);
        if (instance == 2) {
            const dvec3 local = positionAt(image, i) - prepared.scene.origin;
            EXPECT_LE(glm::distance(uv, dvec2((local.x + 4.0) / 8.0, (4.0 - local.z) / 8.0)), 1e-4) << i;
            EXPECT_NEAR(local.y, -1.0, 3e-4);
        } else {
            EXPECT_TRUE(std::isnan(uv.x) && std::isnan(uv.y));
        }
    }
    ASSERT_EQ(pixels.size(), 6U) << "balls, floor, cloud, sphere and nothing";
    for (const auto& [instance, count] : pixels) {
        EXPECT_GT(count, 30U) << instance;
    }
}

// Rigid motions, by depth and pose alone.
TEST(SurfacesTest, FlowIsDepthAndPose)
{
    for (const std::uint64_t maxFlatTriangles : {kMaxFlatTriangles, std::uint64_t{0}}) {
        const PreparedScene prepared = prepare(yard(), maxFlatTriangles);
        EXPECT_EQ(prepared.primitives.sharedMeshes.empty(), maxFlatTriangles != 0);
        const Camera camera = prepared.scene.cameras.front(), other = turned({0.4, 0.5, 3.7}, -0.1);
        Scene then = prepared.scene;
        const dvec3 axis = glm::normalize(dvec3(0.2, 1.0, -0.3));
        std::vector<glm::dmat4> motions;
        for (std::size_t i = 0; i < then.instances.size(); ++i) {
            const dvec3 at(then.instances[i].worldFromMesh[3]);
            const double angle = 0.1 * static_cast<double>(i + 1);
            motions.push_back(glm::translate(glm::dmat4(1.0), at + dvec3(0.1, 0.05, -0.1)) * glm::rotate(glm::dmat4(1.0), angle, axis) *
                              glm::translate(glm::dmat4(1.0), -at));
            then.instances[i].worldFromMesh = motions.back() * then.instances[i].worldFromMesh;
        }
        then.spheres[0].center += glm::vec3(0.1F, 0.2F, 0.0F);
        motions.push_back(glm::translate(glm::dmat4(1.0), dvec3(glm::vec3(0.1F, 0.2F, 0.0F))));
        const Flow flow{{then, flatten(other)}, {prepared.scene, flatten(other)}};
        const Image image = Tracing(prepared, camera, &flow).image();
        const dvec3 eye = prepared.scene.origin + dvec3(camera.position), otherEye = prepared.scene.origin + dvec3(other.position);
        const double focal = 0.5 * kSize.y / std::tan(0.5 * static_cast<double>(camera.yfov));
        for (std::size_t i = 0; i < std::size_t{kSize.x} * kSize.y; ++i) {
            const dvec2 off = (centerOf(i) - 0.5 * dvec2(kSize)) / focal;
            const dvec3 ray = glm::normalize(dvec3(camera.forward) + off.x * dvec3(camera.right) - off.y * dvec3(camera.up));
            const std::uint32_t instance = image.counts.at("instance.X")[i];
            const bool isNothing = instance == kNoIndex;
            const dvec3 place = eye + (isNothing ? 0.0 : static_cast<double>(image.channels.at("distance.Y")[i])) * ray;
            const dvec3 moved = isNothing ? dvec3(0.0) : dvec3(motions[instance] * glm::dvec4(place, 1.0));
            const dvec2 forward = pinhole(other, isNothing ? ray : moved - otherEye) - centerOf(i);
            const dvec2 backward = pinhole(other, isNothing ? ray : place - otherEye) - centerOf(i);
            ASSERT_LE(glm::distance(pairAt(image, "forwardFlow.", "XY", i), forward), 1e-3) << i << " of " << instance;
            ASSERT_LE(glm::distance(pairAt(image, "backwardFlow.", "XY", i), backward), 1e-3) << i << " of " << instance;
        }
    }
}

// A skin: any motion of the vertices. The triangle is found anew, by the place.
TEST(SurfacesTest, FlowOfASkinFollowsItsVertices)
{
    const PreparedScene prepared = prepare(yard());
    const Camera camera = prepared.scene.cameras.front();
    Scene then = prepared.scene;
    for (dvec3& p : then.meshes.change()[0].positions) {
        p += 0.2 * dvec3(std::sin(3.0 * p.y), std::cos(2.0 * p.x), p.x * p.y);
    }
    const Flow flow{{then, flatten(camera)}, {prepared.scene, flatten(camera)}};
    const Image image = Tracing(prepared, camera, &flow).image();
    const dvec3 eye = prepared.scene.origin + dvec3(camera.position);
    const Mesh &mesh = prepared.scene.meshes[0], &bent = then.meshes[0];
    std::size_t tested = 0;
    for (std::size_t i = 0; i < std::size_t{kSize.x} * kSize.y; ++i) {
        const std::uint32_t instance = image.counts.at("instance.X")[i];
        if (instance > 1) {
            continue;
        }
        const glm::dmat4& worldFromMesh = prepared.scene.instances[instance].worldFromMesh;
        const dvec3 toEye = dvec3(glm::inverse(worldFromMesh) * glm::dvec4(eye, 1.0));
        const dvec3 place = dvec3(glm::inverse(worldFromMesh) * glm::dvec4(positionAt(image, i), 1.0));
        const dvec3 ray = place - toEye;
        // The nearest triangle that the ray crosses (Cramer's rule).
        double nearest = std::numeric_limits<double>::infinity();
        dvec3 moved;
        for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
            const dvec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                        c = mesh.positions[mesh.indices[t + 2]];
            const dvec3 x = glm::inverse(glm::dmat3(b - a, c - a, -ray)) * (toEye - a);
            if (x.x >= -1e-9 && x.y >= -1e-9 && x.x + x.y <= 1.0 + 1e-9 && x.z > 0.0 && x.z < nearest) {
                nearest = x.z;
                moved = (1.0 - x.x - x.y) * bent.positions[mesh.indices[t]] + x.x * bent.positions[mesh.indices[t + 1]] +
                        x.y * bent.positions[mesh.indices[t + 2]];
            }
        }
        ASSERT_NEAR(nearest, 1.0, 1e-3);
        const dvec2 expected = pinhole(camera, dvec3(worldFromMesh * glm::dvec4(moved, 1.0)) - eye) - centerOf(i);
        ASSERT_LE(glm::distance(pairAt(image, "forwardFlow.", "XY", i), expected), 5e-3) << i;  // of places in float32
        ++tested;
    }
    EXPECT_GT(tested, 200U);
}

// Where it will be behind the camera, or is no more.
TEST(SurfacesTest, FlowOfWhatIsNotSeenThenIsNone)
{
    const PreparedScene prepared = prepare(yard());
    Scene without = prepared.scene;
    without.spheres.clear();
    without.instances.erase(without.instances.begin());
    const Camera camera = prepared.scene.cameras.front(), away = turned({0.2, 0.6, 4.0}, std::numbers::pi);
    const Flow flow{{prepared.scene, flatten(away)}, {without, flatten(camera)}};
    const Image image = Tracing(prepared, camera, &flow).image();
    for (std::size_t i = 0; i < std::size_t{kSize.x} * kSize.y; ++i) {
        const std::uint32_t instance = image.counts.at("instance.X")[i];
        EXPECT_TRUE(std::isnan(pairAt(image, "forwardFlow.", "XY", i).x)) << i;
        EXPECT_EQ(std::isnan(pairAt(image, "backwardFlow.", "XY", i).x), instance == 0 || instance == 4) << i << " of " << instance;
    }
}

void addCard(SceneBuilder& builder, const dvec2& low, const dvec2& high, float z)
{
    const auto material = builder.lambert(glm::vec3(0.5F));
    const glm::vec2 a(low), b(high);
    builder.quad({{{a.x, a.y, z}, {b.x, a.y, z}, {b.x, b.y, z}, {a.x, b.y, z}}}, material);
}

// Cards that an orthographic camera sees, of 8 pixels a metre: 64 x 48 pixels are 8 x 6 m.
Scene cards()
{
    SceneBuilder builder;
    builder.orthographic({0, 0, 5}, {0, 0, 0}, 3.0F);
    addCard(builder, {-3, -2}, {1, 2}, 0.0F);     // 32 x 32 pixels at 8, 8
    addCard(builder, {0, -1}, {2, 1}, 1.0F);      // in front: 16 x 16 at 32, 16
    addCard(builder, {0.5, -0.5}, {1, 0}, 0.5F);  // hidden: 4 x 4 at 36, 24
    addCard(builder, {3.5, 2.5}, {9, 9}, 0.0F);   // partly outside: 4 x 4 at 60, 0
    addCard(builder, {0, -9}, {1, -8}, 0.0F);     // outside
    return nameParts(builder.scene());
}

TEST(SeenInstancesTest, BoxesAndPixelsAreThoseOfCards)
{
    const PreparedScene prepared = prepare(cards());
    const Json json = Tracing(prepared, prepared.scene.cameras.front()).objects();
    const auto& all = json.at("instances").elements();
    ASSERT_EQ(all.size(), 5U);
    const auto expect = [&](std::size_t i, const char* what, const std::string& text) {
        EXPECT_EQ(all[i].at(what).dump(), text) << i << " " << what;
    };
    expect(0, "pixels", std::to_string(32 * 32 - 8 * 16));
    expect(0, "bbox", "[8,8,32,32]");
    expect(0, "full_pixels", "1024");
    expect(0, "visible", "0.875");
    expect(1, "pixels", "256");
    expect(1, "bbox", "[32,16,16,16]");
    expect(1, "visible", "1.0");
    expect(2, "pixels", "0");
    expect(2, "bbox", "null");
    expect(2, "full_bbox", "[36,24,4,4]");
    expect(2, "visible", "0.0");
    expect(3, "bbox", "[60,0,4,4]");
    expect(4, "full_pixels", "0");
    expect(4, "full_bbox", "null");
    expect(4, "visible", "null");
    EXPECT_EQ(json.at("images").at(std::size_t{0}).dump(), R"({"id":1,"width":64,"height":48,"file_name":"a.exr"})");
}

TEST(SeenInstancesTest, MasksAreRunsOfColumns)
{
    const PreparedScene prepared = prepare(cards());
    Tracing tracing(prepared, prepared.scene.cameras.front());
    const std::vector<std::uint32_t> ids = tracing.image().counts.at("instance.X");
    const Json json = tracing.objects();
    const auto& annotations = json.at("annotations").elements();
    ASSERT_EQ(annotations.size(), 3U) << "those that are seen";
    for (const Json& annotation : annotations) {
        EXPECT_EQ(annotation.at("segmentation").at("size").dump(), "[48,64]");
        std::vector<bool> mask;
        bool isIn = false;
        for (const Json& run : annotation.at("segmentation").at("counts").elements()) {
            mask.insert(mask.end(), run.count(), isIn);
            isIn = !isIn;
        }
        ASSERT_EQ(mask.size(), ids.size());
        for (std::uint32_t y = 0; y < kSize.y; ++y) {
            for (std::uint32_t x = 0; x < kSize.x; ++x) {
                EXPECT_EQ(mask[std::size_t{x} * kSize.y + y], ids[std::size_t{y} * kSize.x + x] + 1 == annotation.at("id").count());
            }
        }
    }
}

}  // namespace
}  // namespace glim
