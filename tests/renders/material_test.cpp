// Pictures of glTF's material, textures, alpha and environments whose answer is known on paper.
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

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

// What the white furnace gives, in every channel: within 5 standard errors and the table's error of 1.5e-3 per look-up.
void expectFurnace(const std::string& name, const Scene& scene, double low, double high)
{
    const MeanEstimate estimate = meanOf(renderScene(scene, squareSettings(64, samplesFor(64))));
    for (int c = 0; c < 3; ++c) {
        EXPECT_GE(estimate.mean[c], low - 5.0 * estimate.standardError[c] - 3e-3) << name;
        EXPECT_LE(estimate.mean[c], high + 5.0 * estimate.standardError[c] + 3e-3) << name;
    }
    std::printf("%s: %.5f +- %.5f\n", name.c_str(), estimate.mean.x, estimate.standardError.x);
}

TEST(MaterialTest, WhiteMetalsAndPlasticsReflectAllLight)
{
    for (const float metallic : {0.0F, 0.5F, 1.0F}) {
        for (const float roughness : {0.0F, 0.04F, 0.2F, 0.5F, 1.0F}) {
            Material material;
            material.metallic = metallic;
            material.roughness = roughness;
            expectFurnace("metallic " + std::to_string(metallic) + ", roughness " + std::to_string(roughness), ballOf(material), 1.0, 1.0);
        }
    }
}

TEST(MaterialTest, NoMaterialReflectsMoreThanItGets)
{
    for (const float specular : {0.0F, 0.3F, 1.0F}) {
        for (const float ior : {0.0F, 1.0F, 1.5F, 3.0F}) {
            Material material;
            material.baseColor = glm::vec3(1.0F, 0.5F, 0.0F);
            material.metallic = 0.3F;
            material.roughness = 0.3F;
            material.specular = specular;
            material.specularColor = glm::vec3(1.0F, 2.0F, 0.5F);
            material.ior = ior;
            expectFurnace("specular " + std::to_string(specular) + ", ior " + std::to_string(ior), ballOf(material), 0.0, 1.0);
        }
    }
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
    textured.materials[0].baseColorTexture.emplace();
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
    Mesh& mesh = scene.meshes[0];
    for (const glm::dvec3& p : mesh.positions) {
        mesh.uv0.emplace_back(glm::vec2(p) * 3.7F);
    }
    if (image != nullptr) {
        scene.images.push_back({"checker", *image});
        scene.materials[0].baseColorTexture.emplace();
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
    checker.materials[0].baseColorTexture->nearest = true;
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
