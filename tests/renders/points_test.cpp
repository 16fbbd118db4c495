// Points are drawn as the same spheres of the scene would be, each with its colour; lines as spheres that move along them.
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/describe_primitive.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

constexpr float kPointRadius = 0.2F;

Material plastic(const glm::vec3& baseColor)
{
    Material material;
    material.baseColor = baseColor;
    material.metallic = 0.0F;
    material.roughness = 0.4F;
    return material;
}

struct Point {
    glm::vec3 center;
    glm::vec4 color;
};

std::vector<Point> somePoints()
{
    Random random(5);
    std::vector<Point> points;
    for (int i = 0; i < 24; ++i) {
        const glm::vec3 place(random.unitFloat(), random.unitFloat(), random.unitFloat());
        points.push_back({2.0F * place - 1.0F, {random.unitFloat(), random.unitFloat(), random.unitFloat(), random.unitFloat()}});
    }
    return points;
}

// A floor, and a sphere that is no point.
Scene surroundings(const Material& material)
{
    SceneBuilder builder;
    const auto grey = builder.lambert(glm::vec3(0.5F));
    builder.quad({{{-3, -1.5F, 3}, {3, -1.5F, 3}, {3, -1.5F, -3}, {-3, -1.5F, -3}}}, grey)
        .sphere({1.5F, 0, 0}, 0.3F, builder.add(material));
    builder.environment(glm::vec3(0.5F)).perspective({0, 1, 6}, {0, 0, 0}, 0.6F);
    return builder.scene();
}

void addCloud(Scene& scene, const std::vector<Point>& points, std::uint32_t material, bool colored)
{
    Mesh mesh;
    mesh.isCloud = true;
    mesh.material = material;
    mesh.pointRadius = static_cast<double>(kPointRadius);
    for (const Point& point : points) {
        mesh.positions.emplace_back(point.center);
        if (colored) {
            mesh.colors.push_back(point.color);
        }
    }
    scene.instances.push_back({"cloud", static_cast<std::uint32_t>(scene.meshes.size())});
    scene.meshes.change().push_back(mesh);
}

// Of material 1, or of one for each that has its colour.
void addSpheres(Scene& scene, const std::vector<Point>& points, bool colored)
{
    for (const Point& point : points) {
        scene.spheres.push_back({"", point.center, kPointRadius, colored ? static_cast<std::uint32_t>(scene.materials.size()) : 1});
        if (colored) {
            scene.materials.push_back(scene.materials[1]);
            scene.materials.back().baseColor *= glm::vec3(point.color);
            scene.materials.back().alpha *= point.color.a;
        }
    }
}

// Whether a picture of points has the bits of one of spheres; and is not that of other points.
void expectSamePicture(const Material& material, bool colored)
{
    const std::vector<Point> points = somePoints();
    Scene cloud = surroundings(material), spheres = cloud, fewer = cloud;
    addCloud(cloud, points, 1, colored);
    addSpheres(spheres, points, colored);
    addCloud(fewer, {points.begin() + 1, points.end()}, 1, colored);
    const RenderSettings settings = squareSettings(48, 4);
    const Film film = renderScene(cloud, settings);
    EXPECT_TRUE(sameBits(film, renderScene(spheres, settings)));
    EXPECT_FALSE(sameBits(film, renderScene(fewer, settings)));
}

TEST(PointsTest, AreTheSpheresAtTheirPlaces) { expectSamePicture(plastic(glm::vec3(0.7F, 0.5F, 0.3F)), false); }

TEST(PointsTest, TheirColoursMultiplyTheBaseColour) { expectSamePicture(plastic(glm::vec3(1.0F)), true); }

TEST(PointsTest, TheirAlphaMultipliesThatOfTheMaterial)
{
    Material glassy = plastic(glm::vec3(1.0F));
    glassy.alphaMode = AlphaMode::Blend;
    expectSamePicture(glassy, true);
}

TEST(PointsTest, ThoseThatEmitAreSphereLights)
{
    Material lamp = plastic(glm::vec3(0.2F));
    lamp.emission = glm::vec3(3.0F, 2.0F, 1.0F);
    expectSamePicture(lamp, false);
    Scene scene = surroundings(lamp);
    addCloud(scene, somePoints(), 1, false);
    EXPECT_EQ(flattened(scene).lights.size(), 26U);  // and the sphere and the environment
}

// Colours of triangles are those of triangles alone. Black is interpolated without rounding.
TEST(PointsTest, SpheresBesideColouredTrianglesStayWhite)
{
    Scene scene = surroundings(plastic(glm::vec3(0.8F)));
    Scene reference = scene;
    scene.materials[0] = reference.materials[0] = plastic(glm::vec3(1.0F));
    scene.meshes.change()[0].colors.assign(scene.meshes[0].positions.size(), glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
    reference.materials[0].baseColor = glm::vec3(0.0F);
    const RenderSettings settings = squareSettings(48, 4);
    EXPECT_TRUE(sameBits(renderScene(scene, settings), renderScene(reference, settings)));
    addCloud(scene, somePoints(), 1, false);
    addCloud(reference, somePoints(), 1, false);
    EXPECT_TRUE(sameBits(renderScene(scene, settings), renderScene(reference, settings)));
}

TEST(PointsTest, AreNamedByTheirInstanceAndTheirNumber)
{
    PreparedScene prepared;
    prepared.scene = surroundings(plastic(glm::vec3(0.8F)));
    addCloud(prepared.scene, somePoints(), 1, false);
    prepared.primitives = makePrimitives(prepared.scene);
    prepared.bvh = buildSceneBvh(prepared.primitives);
    prepared.flat = flattenScene(prepared.scene, prepared.primitives, prepared.bvh);
    std::vector<int> met(somePoints().size(), 0);
    for (std::uint32_t ref = 0; ref < prepared.bvh.order.size(); ++ref) {
        const PrimitiveDescription described = describePrimitive(prepared, ref);
        if (described.point) {
            ++met.at(*described.point);
            EXPECT_EQ(toText(described), "instance \"cloud\", point " + std::to_string(*described.point));
        }
    }
    EXPECT_EQ(met, std::vector<int>(met.size(), 1));
}

// Lines between these points, one after the other.
Scene strip(const Material& material, const std::vector<Point>& points, bool colored)
{
    Scene scene = surroundings(material);
    addCloud(scene, points, 1, colored);
    for (std::uint32_t i = 1; i < points.size(); ++i) {
        scene.meshes.change().back().lines.emplace_back(i - 1, i);
    }
    return scene;
}

std::vector<Point> straightPoints(const glm::vec3& from, const glm::vec3& to, int count, const glm::vec4& color = glm::vec4(1.0F))
{
    std::vector<Point> points;
    for (int i = 0; i < count; ++i) {
        points.push_back({from + (to - from) * (static_cast<float>(i) / static_cast<float>(count - 1)), color});
    }
    return points;
}

// A row of spheres that overlap by all but a thousandth of their radius: the ripple between them is 1e-7 of it.
TEST(LinesTest, AreSpheresThatMove)
{
    const glm::vec3 from(-1.0F, -0.5F, 0.5F), to(0.5F, 1.0F, -0.5F);
    const RenderSettings settings = squareSettings(32, 64);
    Scene spheres = surroundings(plastic(glm::vec3(0.7F, 0.5F, 0.3F)));
    addCloud(spheres, straightPoints(from, to, 1000), 1, false);
    RenderSettings other = settings;
    other.seed = 1;
    expectSameMean("line and spheres", renderScene(strip(plastic(glm::vec3(0.7F, 0.5F, 0.3F)), {{from, {}}, {to, {}}}, false), settings),
                   renderScene(spheres, other));
}

TEST(LinesTest, ALineInPartsIsTheWholeLine)
{
    const glm::vec3 from(-1.0F, -0.5F, 0.5F), to(0.5F, 1.0F, -0.5F);
    const Material material = plastic(glm::vec3(0.7F, 0.5F, 0.3F));
    RenderSettings settings = squareSettings(32, 64);
    const Film whole = renderScene(strip(material, straightPoints(from, to, 2), false), settings);
    settings.seed = 1;
    expectSameMean("line of parts", renderScene(strip(material, straightPoints(from, to, 9), false), settings), whole);
}

TEST(LinesTest, TheirColoursAreThoseOfTheMaterial)
{
    const glm::vec4 color(0.25F, 0.5F, 0.75F, 1.0F);
    const std::vector<Point> points = straightPoints({-1, 0, 0}, {1, 0.5F, 0}, 4, color);
    const RenderSettings settings = squareSettings(48, 4);
    Scene plain = strip(plastic(glm::vec3(0.25F, 0.5F, 0.75F)), points, false), colored = strip(plastic(glm::vec3(1.0F)), points, true);
    plain.spheres.clear();
    colored.spheres.clear();
    EXPECT_TRUE(sameBits(renderScene(colored, settings), renderScene(plain, settings)));
}

// They are found by chance alone, which is slower and not darker. So is a row of sphere lights.
TEST(LinesTest, ThoseThatEmitShineAsSphereLightsDo)
{
    Material lamp = plastic(glm::vec3(0.2F));
    lamp.emission = glm::vec3(3.0F, 2.0F, 1.0F);
    const glm::vec3 from(-1.0F, -0.8F, 0.5F), to(0.5F, -0.5F, -0.5F);
    Scene line = strip(lamp, {{from, {}}, {to, {}}}, false), spheres = surroundings(lamp);
    addCloud(spheres, straightPoints(from, to, 200), 1, false);
    EXPECT_EQ(flattened(line).lights.size(), 2U);  // the sphere and the environment
    RenderSettings settings = squareSettings(32, 64);
    const Film film = renderScene(line, settings);
    settings.seed = 1;
    expectSameMean("emitting line and spheres", film, renderScene(spheres, settings));
}

TEST(LinesTest, TheirAlphaLetsLightThrough)
{
    Material veil = plastic(glm::vec3(0.8F)), half = veil;
    half.alphaMode = veil.alphaMode = AlphaMode::Blend;
    half.alpha = 0.5F;
    const std::vector<Point> points = straightPoints({-1, 0, 0}, {1, 0.5F, 0}, 4, glm::vec4(1.0F, 1.0F, 1.0F, 0.5F));
    const RenderSettings settings = squareSettings(48, 4);
    Scene byColor = strip(veil, points, true), byMaterial = strip(half, points, false), opaque = strip(veil, points, false);
    for (Scene* scene : {&byColor, &byMaterial, &opaque}) {
        scene->spheres.clear();
    }
    const Film film = renderScene(byColor, settings);
    EXPECT_TRUE(sameBits(film, renderScene(byMaterial, settings)));
    EXPECT_FALSE(sameBits(film, renderScene(opaque, settings)));
}

}  // namespace
}  // namespace glim
