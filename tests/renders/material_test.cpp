// Pictures of glTF's material, textures, alpha and environments whose answer is known on paper.
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <random>
#include <sstream>

namespace glim {
namespace {

// A ball under a sky of radiance 1 that fills the picture's middle.
Scene ballOf(const Material& material)
{
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1.0F, builder.lambert(glm::vec3(0.5F))).environment(glm::vec3(1.0F)).perspective({0, 0, 5}, {0, 0, 0}, 0.2F);
    Scene scene = builder.scene();
    scene.materials[0] = material;
    return scene;
}

// In every channel, up to 5 standard errors and the albedo table's error of 1.5e-3 per look-up.
void expectWithin(const std::string& name, const MeanEstimate& estimate, double low, double high)
{
    for (int c = 0; c < 3; ++c) {
        EXPECT_GE(estimate.mean[c], low - 5.0 * estimate.standardError[c] - 3e-3) << name;
        EXPECT_LE(estimate.mean[c], high + 5.0 * estimate.standardError[c] + 3e-3) << name;
    }
    std::printf("%s: %.5f +- %.5f\n", name.c_str(), estimate.mean.x, estimate.standardError.x);
}

// What the white furnace gives.
void expectFurnace(const std::string& name, const Scene& scene, double low, double high)
{
    expectWithin(name, meanOf(renderScene(scene, squareSettings(32, samplesFor(64)))), low, high);
}

constexpr int kColumns = 20, kRows = 10, kBlock = 16;  // pixels along the side of a ball's block

// Balls in a grid, seen in parallel, one to each block of the picture: one compilation of kernels for all of them. White ones fill it.
Scene gridOf(std::vector<Material> materials)
{
    materials.resize(kColumns * kRows, makeLambert(glm::vec3(1.0F)));
    SceneBuilder builder;
    for (int i = 0; i < kColumns * kRows; ++i) {
        const glm::vec3 center(static_cast<float>(i % kColumns) + 0.5F, static_cast<float>(kRows - 1 - i / kColumns) + 0.5F, 0.0F);
        builder.sphere(center, 0.45F, builder.lambert(glm::vec3(0.5F)));
    }
    builder.environment(glm::vec3(1.0F)).perspective({0, 0, 5}, {0, 0, 0}, 0.2F);
    Scene scene = builder.scene();
    scene.materials = std::move(materials);
    Camera& camera = scene.cameras[0];
    camera.kind = Camera::Kind::Orthographic;
    camera.position = {0.5F * kColumns, 0.5F * kRows, 5.0F};
    camera.halfWidth = 0.5F * kColumns;
    camera.halfHeight = 0.5F * kRows;
    return scene;
}

Film blockOf(const Film& film, int ball)
{
    Film block;
    for (int y = 0; y < kBlock; ++y) {
        const int row = ball / kColumns * kBlock + y;
        const auto first = film.pixels.begin() + row * kColumns * kBlock + ball % kColumns * kBlock;
        block.pixels.insert(block.pixels.end(), first, first + kBlock);
    }
    return block;
}

RenderSettings gridSettings()
{
    RenderSettings settings = squareSettings(kColumns * kBlock, samplesFor(64));
    settings.height = kRows * kBlock;
    return settings;
}

// The furnace of each of some materials.
void expectFurnaces(const std::vector<std::pair<std::string, Material>>& cases, double low, double high)
{
    std::vector<Material> materials;
    for (const auto& [name, material] : cases) {
        materials.push_back(material);
    }
    const Film film = renderScene(gridOf(materials), gridSettings());
    for (std::size_t i = 0; i < cases.size(); ++i) {
        expectWithin(cases[i].first, meanOf(blockOf(film, static_cast<int>(i))), low, high);
    }
}

Material clearGlass(float roughness)
{
    Material material;
    material.metallic = 0.0F;
    material.transmission = 1.0F;
    material.roughness = roughness;
    material.specularColor = glm::vec3(1.0F, 1.0F, 0.999F);  // not the simple lobe
    return material;
}

TEST(MaterialTest, WhiteMetalsAndPlasticsReflectAllLight)
{
    std::vector<std::pair<std::string, Material>> cases;
    for (const float metallic : {0.0F, 0.5F, 1.0F}) {
        for (const float roughness : {0.0F, 0.04F, 0.2F, 0.5F, 1.0F}) {
            Material material;
            material.metallic = metallic;
            material.roughness = roughness;
            cases.emplace_back("metallic " + std::to_string(metallic) + ", roughness " + std::to_string(roughness), material);
        }
    }
    expectFurnaces(cases, 1.0, 1.0);
}

TEST(MaterialTest, NoMaterialReflectsMoreThanItGets)
{
    std::vector<std::pair<std::string, Material>> cases;
    for (const float specular : {0.0F, 0.3F, 1.0F}) {
        for (const float ior : {0.0F, 1.0F, 1.5F, 3.0F}) {
            Material material;
            material.baseColor = glm::vec3(1.0F, 0.5F, 0.0F);
            material.metallic = 0.3F;
            material.roughness = 0.3F;
            material.specular = specular;
            material.specularColor = glm::vec3(1.0F, 2.0F, 0.5F);
            material.ior = ior;
            cases.emplace_back("specular " + std::to_string(specular) + ", ior " + std::to_string(ior), material);
        }
    }
    expectFurnaces(cases, 0.0, 1.0);
}

// Full materials, at random: every lobe at once.
Material randomMaterial(std::mt19937& random)
{
    const auto number = [&random] { return std::uniform_real_distribution<float>(0.0F, 1.0F)(random); };
    const auto share = [&] { return number() < 0.3F ? 0.0F : number() < 0.3F ? 1.0F : number(); };
    const auto color = [&] { return glm::vec3(share(), share(), share()); };
    Material m;
    m.baseColor = color();
    m.metallic = share();
    m.roughness = share();
    m.specular = share();
    m.specularColor = color();
    m.ior = 1.0F + 2.0F * number();
    m.transmission = share();
    m.solid = number() < 0.5F && m.transmission > 0.0F;
    m.diffuseTransmission = share();
    m.diffuseTransmissionColor = color();
    m.clearcoat = share();
    m.clearcoatRoughness = share();
    m.sheenColor = color();
    m.sheenRoughness = share();
    m.anisotropy = 0.5F * share();  // beyond, the isotropic table creates up to 6 % (tests/oracle)
    m.anisotropyRotation = 6.0F * number();
    m.iridescence = share();
    m.iridescenceIor = 1.0F + number();
    m.iridescenceThicknessMaximum = 1000.0F * number();
    return m;
}

std::string describe(const Material& m)
{
    std::ostringstream text;
    text << "base " << m.baseColor.r << ' ' << m.baseColor.g << ' ' << m.baseColor.b << ", metallic " << m.metallic << ", roughness "
         << m.roughness << ", specular " << m.specular << ", ior " << m.ior << ", transmission " << m.transmission
         << (m.solid ? " solid" : "") << ", diffuse transmission " << m.diffuseTransmission << ", coat " << m.clearcoat << ' '
         << m.clearcoatRoughness << ", sheen " << m.sheenColor.r << ' ' << m.sheenColor.g << ' ' << m.sheenColor.b << ' '
         << m.sheenRoughness << ", anisotropy " << m.anisotropy << ", film " << m.iridescence << ' ' << m.iridescenceIor << ' '
         << m.iridescenceThicknessMaximum;
    return text.str();
}

// In a furnace of radiance 1 nothing is brighter than 1, seen from outside, through it or in its neighbours.
TEST(MaterialTest, TwoHundredRandomMaterialsCreateNoEnergy)
{
    std::mt19937 random(1);
    std::vector<Material> materials;
    for (int i = 0; i < kColumns * kRows; ++i) {
        materials.push_back(randomMaterial(random));
    }
    const Film film = renderScene(gridOf(materials), gridSettings());
    double most = 0.0, worst = 0.0;
    for (int i = 0; i < kColumns * kRows; ++i) {
        const MeanEstimate estimate = meanOf(blockOf(film, i));
        for (int c = 0; c < 3; ++c) {
            EXPECT_LE(estimate.mean[c], 1.0 + 5.0 * estimate.standardError[c] + 5e-3) << describe(materials[static_cast<std::size_t>(i)]);
            most = std::max(most, estimate.mean[c]);
            worst = std::max(worst, estimate.standardError[c]);
        }
    }
    // Of a bounded weight: fireflies give standard errors of .1.
    EXPECT_LT(worst, 0.01);
    std::printf("brightest of 200 random materials: %.4f, largest standard error %.4f\n", most, worst);
}

// Layers over a white base take nothing away.
TEST(MaterialTest, WhiteUnderACoatStaysAlmostWhite)
{
    for (const float roughness : {0.0F, 0.3F, 1.0F}) {
        Material material = makeLambert(glm::vec3(1.0F));
        material.clearcoat = 1.0F;
        material.clearcoatRoughness = roughness;
        // The coat's coupling is by the lesser of both directions' shares (access/principled.glsl).
        expectFurnace("coat of roughness " + std::to_string(roughness), ballOf(material), 0.94, 1.0);
    }
}

// A ball of clear glass lets the sky through unchanged, smooth or rough.
TEST(MaterialTest, ClearGlassInAFurnaceIsInvisible)
{
    std::vector<std::pair<std::string, Material>> cases;
    for (const bool solid : {true, false}) {
        for (const float ior : {1.1F, 1.5F, 2.0F}) {
            for (const float roughness : {0.0F, 0.04F, 0.3F, 0.5F, 0.7F, 1.0F}) {
                Material material = clearGlass(roughness);
                material.solid = solid;
                material.ior = ior;
                cases.emplace_back(
                    (solid ? "solid" : "thin") + (" glass of roughness " + std::to_string(roughness)) + ", index " + std::to_string(ior),
                    material);
            }
        }
    }
    expectFurnaces(cases, 1.0, 1.0);
}

// A white pane keeps all light, of which single scattering loses up to .69 (albedos at normal incidence by quadrature; 1 - ln 2 at alpha
// 1). A tint is lost on all of it but what is reflected: Schlick's .04 of single scattering, and little more.
TEST(MaterialTest, RoughPanesKeepTheirTint)
{
    struct Expected {
        double alpha, albedo;
    };
    for (const Expected& e : {Expected{0.25, 0.9157}, Expected{1.0, 1.0 - std::log(2.0)}}) {
        SceneBuilder builder;
        builder.quad({{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}}, builder.lambert(glm::vec3(0.0F)))
            .environment(glm::vec3(1.0F))
            .perspective({0, 0, 3}, {0, 0, 0}, 0.02F);
        Scene scene = builder.scene();
        scene.materials[0] = clearGlass(static_cast<float>(std::sqrt(e.alpha)));
        expectFurnace("a white pane of alpha " + std::to_string(e.alpha), scene, 1.0, 1.0);
        scene.materials[0].baseColor = glm::vec3(0.5F);
        const double reflected = 0.04 * e.albedo;
        expectFurnace("a grey pane of alpha " + std::to_string(e.alpha), scene, 0.5 + 0.5 * reflected, 0.5 + 0.5 * reflected + 0.002);
    }
}

// A factor of 0 gives the bits of a material without the layer.
TEST(MaterialTest, LayersOfFactorZeroChangeNoBit)
{
    Material plain;
    plain.baseColor = glm::vec3(0.8F, 0.5F, 0.2F);
    plain.metallic = plain.roughness = 0.5F;
    Material layered = plain;
    layered.clearcoatRoughness = 0.5F;
    layered.sheenRoughness = 0.5F;
    layered.anisotropyRotation = 1.0F;
    layered.iridescenceIor = 1.8F;
    layered.diffuseTransmissionColor = glm::vec3(0.5F);
    layered.dispersion = 1.0F;
    EXPECT_TRUE(sameBits(renderScene(ballOf(plain), squareSettings(16, 8)), renderScene(ballOf(layered), squareSettings(16, 8))));
}

// Beer and Lambert: through the middle of a ball whose index is that of air.
TEST(MaterialTest, LightIsAbsorbedByTheLengthOfItsWay)
{
    Material material;
    material.metallic = material.roughness = 0.0F;
    material.transmission = 1.0F;
    material.solid = true;
    material.ior = 1.0F;
    material.absorption = glm::vec3(0.1F, 1.0F, 0.0F);
    Scene scene = ballOf(material);
    scene.cameras[0].yfov = 1e-3F;
    const glm::dvec3 expected(std::exp(-0.2), std::exp(-2.0), 1.0);
    const MeanEstimate estimate = meanOf(renderScene(scene, squareSettings(8, 8)));
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(estimate.mean[c], expected[c], 1e-5);
    }
}

// A ball within a ball: the inner one is left before the outer one, and both are left in the end.
TEST(MaterialTest, NestedGlassInAFurnaceIsInvisible)
{
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1.0F, builder.glass(1.5F))
        .sphere({0.2F, 0.1F, 0}, 0.5F, builder.glass(1.2F))
        .environment(glm::vec3(1.0F))
        .perspective({0, 0, 5}, {0, 0, 0}, 0.4F);
    expectMean("nested glass", renderScene(builder.scene(), squareSettings(64, samplesFor(64))), glm::dvec3(1.0));
    // Where a third ball pokes out of the first, light may be caught for more bounces than a path has: .0009 of it after 64, .0001 after
    // 2000.
    builder.sphere({0.9F, 0, 0}, 0.4F, builder.glass(1.8F));
    expectFurnace("overlapping glass", builder.scene(), 0.999, 1.0);
}

// White light stays white on average, whatever wavelength a path takes.
TEST(MaterialTest, DispersionKeepsWhite)
{
    SceneBuilder builder;
    const std::uint32_t glass = builder.glass(1.5F);
    builder.sphere({0, 0, 0}, 1.0F, glass).environment(glm::vec3(1.0F)).perspective({0, 0, 5}, {0, 0, 0}, 0.4F);
    Scene scene = builder.scene();
    scene.materials[glass].dispersion = 2.0F;
    expectMean("dispersive glass", renderScene(scene, squareSettings(64, samplesFor(256))), glm::dvec3(1.0));
}

// A pane before a lamp. Shadow rays pass a smooth thin wall; a trace of sheen makes them stop, and light finds its way by chance alone.
TEST(MaterialTest, LampsBehindPanesAreFoundByLightsAndByChanceAlike)
{
    SceneBuilder builder;
    const std::uint32_t white = builder.lambert(glm::vec3(0.5F)), lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(10.0F));
    const std::uint32_t pane = builder.lambert(glm::vec3(0.0F));
    builder.quad({{{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}}}, white)
        .quad({{{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}}, lamp)
        .quad({{{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}}, pane)
        .perspective({0, 0.5F, 3}, {0, 0, 0}, 0.5F);
    Scene scene = builder.scene();
    Material& glass = scene.materials[pane];
    glass = Material{};
    glass.baseColor = glm::vec3(0.9F, 0.5F, 0.1F);
    glass.metallic = glass.roughness = 0.0F;
    glass.transmission = 1.0F;
    const Film straight = renderScene(scene, squareSettings(32, samplesFor(1024)));
    glass.sheenColor = glm::vec3(1e-12F);
    glass.sheenRoughness = 1.0F;
    RenderSettings settings = squareSettings(32, samplesFor(4096));
    settings.seed = 1;
    expectSameMean("light through a pane", straight, renderScene(scene, settings));
}

// Seen by the camera as it is, and by nothing else.
TEST(MaterialTest, UnlitSurfacesShowTheirColourAndShadeNothing)
{
    SceneBuilder builder;
    const std::uint32_t floor = builder.lambert(glm::vec3(0.5F)), unlit = builder.lambert(glm::vec3(0.25F, 0.5F, 1.0F));
    builder.quad({{{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}}}, floor)
        .sphere({0, 1, 0}, 0.5F, unlit)
        .environment(glm::vec3(1.0F))
        .perspective({0, 1, 5}, {0, 1, 0}, 0.05F);
    Scene scene = builder.scene();
    scene.materials[unlit].unlit = true;
    RenderSettings settings = squareSettings(16, 64);
    settings.bounces = 2;
    expectEverywhere(renderScene(scene, squareSettings(16, 16)), glm::dvec3(0.25, 0.5, 1.0), 1);
    scene.cameras[0].forward = glm::normalize(glm::vec3(0, -1, -5));
    Scene empty = scene;
    empty.spheres.clear();
    scene.cameras[0].position = empty.cameras[0].position = {0, 0.3F, 1.9F};
    expectSameMean("the floor below", renderScene(scene, settings), renderScene(empty, settings));
}

// A material that is set up as principled but reflects nothing is Lambert.
TEST(MaterialTest, ATextureOfOneColourIsPartOfTheFactor)
{
    Scene plain = ballOf(makeLambert(glm::vec3(0.5F)));
    Scene textured = ballOf(makeLambert(glm::vec3(1.0F)));
    DecodedImage image;
    image.width = image.height = 2;
    image.rgba16.assign(16, 65535);
    for (std::size_t i = 0; i < 16; ++i) {
        image.rgba16[i] = i % 4 == 3 ? 65535 : 48192;  // sRGB of .5, to 16 bits
    }
    textured.images.push_back({"half", image});
    textured.materials[0].textures[kSlotBaseColor].emplace();
    const Film a = renderScene(plain, squareSettings(32, 64)), b = renderScene(textured, squareSettings(32, 64));
    EXPECT_NEAR(meanOf(a).mean.x, meanOf(b).mean.x, 2e-5);
}

Scene quadOf(const Material& material, const DecodedImage* image)
{
    SceneBuilder builder;
    builder.quad({{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}}, builder.lambert(glm::vec3(0.0F)))
        .environment(glm::vec3(1.0F))
        .perspective({0, 0, 3}, {0, 0, 0}, 0.3F);
    Scene scene = builder.scene();
    scene.materials[0] = material;
    Mesh& mesh = scene.meshes.change()[0];
    for (const glm::dvec3& p : mesh.positions) {
        mesh.uv0.emplace_back(glm::vec2(p) * 3.7F);
    }
    if (image != nullptr) {
        scene.images.push_back({"checker", *image});
        scene.materials[0].textures[kSlotBaseColor].emplace();
    }
    return scene;
}

// Coverage a of a black card lets 1 - a of the sky through, from in front and to what lies behind.
TEST(MaterialTest, AlphaIsCoverage)
{
    Material card = makeLambert(glm::vec3(0.0F));
    card.alphaMode = AlphaMode::Blend;
    card.alpha = 0.3F;
    expectMean("a card of alpha .3", renderScene(quadOf(card, nullptr), squareSettings(64, 64)), glm::dvec3(0.7));
    DecodedImage image;
    image.width = image.height = 2;
    image.rgba8 = {255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 0, 255, 255, 255, 255};
    card.alpha = 1.0F;
    card.alphaMode = AlphaMode::Mask;
    Scene checker = quadOf(card, &image);
    checker.materials[0].textures[kSlotBaseColor]->nearest = true;
    expectMean("a checker of holes", renderScene(checker, squareSettings(64, 256)), glm::dvec3(0.5));
}

// The same picture, whether the environment is constant or a map of one colour; rotation changes nothing.
TEST(MaterialTest, AConstantMapIsAConstantEnvironment)
{
    Scene scene = ballOf(makeLambert(glm::vec3(0.5F, 0.25F, 1.0F)));
    auto map = std::make_shared<RadianceMap>();
    map->width = 8;
    map->height = 4;
    map->texels.assign(32, glm::vec3(1.0F, 2.0F, 4.0F));
    scene.environment->map = map;
    scene.environment->radiance = glm::vec3(0.5F);
    scene.environment->rotation = 1.0F;
    expectMean("a map of one colour", renderScene(scene, squareSettings(64, 64)), glm::dvec3(0.25, 0.25, 2.0));
}

// One bright texel at a pole and one on the horizon, over a horizontal floor: irradiance by quadrature over the bilinear map would need
// the renderer's own filter, so the two ways to find the light are compared instead.
TEST(MaterialTest, SunsAreFoundByLightsAndByBsdfsAlike)
{
    Scene scene = ballOf(makeLambert(glm::vec3(0.5F)));
    auto map = std::make_shared<RadianceMap>();
    map->width = 16;
    map->height = 8;
    map->texels.assign(128, glm::vec3(0.1F));
    map->texels[3] = glm::vec3(20.0F);
    map->texels[16 * 4 + 12] = glm::vec3(30.0F, 20.0F, 10.0F);
    scene.environment->map = map;
    RenderSettings bsdf = squareSettings(64, samplesFor(1024)), lights = bsdf, both = bsdf;
    bsdf.course.direct = DirectLight::Bsdf;
    lights.course.direct = DirectLight::Lights;
    lights.seed = 1;
    both.seed = 2;
    const Film a = renderScene(scene, bsdf), b = renderScene(scene, lights), c = renderScene(scene, both);
    expectSameMean("suns by BSDFs and by lights", a, b);
    expectSameMean("suns by MIS and by lights", c, b);
}

}  // namespace
}  // namespace glim
