// Which glTF material becomes which of glim's, and the line that says what is left out.
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace glim::test {
namespace {

using nlohmann::json;

struct Mapped {
    Material material;
    std::vector<std::string> warnings;
};

Mapped map(const json& material, const std::vector<std::string>& textures = {})
{
    GltfBuilder builder;
    builder.append("materials", material);
    for (std::size_t i = 0; i < textures.size(); ++i) {
        builder.append("textures", json::object());
    }
    const std::size_t mesh = builder.addTriangleMesh();
    builder.document["meshes"][mesh]["primitives"][0]["material"] = 0;
    builder.addNode({{"mesh", mesh}});
    builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
    builder.addNode({{"camera", 0}});
    const Scene scene = load(builder);
    return {scene.materials.at(scene.meshes.at(0).material), scene.warnings};
}

json specular(double factor) { return {{"KHR_materials_specular", {{"specularFactor", factor}}}}; }

json lambert()
{
    return {{"name", "clay"},
            {"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 0.75, 1}}, {"metallicFactor", 0}}},
            {"extensions", specular(0)}};
}

json glass()
{
    return {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
            {"extensions",
             {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
              {"KHR_materials_volume", {{"thicknessFactor", 1}}},
              {"KHR_materials_ior", {{"ior", 1.75}}}}}};
}

using Warnings = std::vector<std::string>;

// One warning, which names the material, what it is drawn as, and these properties alone.
void expectIgnored(const Warnings& warnings, const std::string& material, const std::string& drawnAs, const Warnings& properties)
{
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(static_cast<std::size_t>(std::count(warnings[0].begin(), warnings[0].end(), ',')), properties.size() - 1) << warnings[0];
    Warnings parts = properties;
    parts.insert(parts.end(), {material, drawnAs});
    for (const std::string& part : parts) {
        EXPECT_NE(warnings[0].find(part), std::string::npos) << part << " is not in: " << warnings[0];
    }
}

TEST(GltfMaterial, PureLambertIsExact)
{
    const Mapped mapped = map(lambert());
    EXPECT_EQ(mapped.warnings, Warnings{});
    EXPECT_EQ(mapped.material.scattering, Scattering::Lambert);
    EXPECT_EQ(mapped.material.baseColor, glm::vec3(0.25F, 0.5F, 0.75F));
    EXPECT_EQ(mapped.material.emission, glm::vec3(0.0F));
    EXPECT_FALSE(mapped.material.doubleSided);
    EXPECT_EQ(mapped.material.name, "clay");
}

TEST(GltfMaterial, EmissionIsFactorTimesStrength)
{
    json lamp = lambert();
    lamp["emissiveFactor"] = {1, 0.5, 0.25};
    lamp["doubleSided"] = true;
    EXPECT_EQ(map(lamp).material.emission, glm::vec3(1, 0.5F, 0.25F));
    lamp["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 5000000000}};
    const Mapped mapped = map(lamp);
    EXPECT_EQ(mapped.material.emission, glm::vec3(5e9F, 2.5e9F, 1.25e9F)) << "whole numbers beyond int too";
    EXPECT_TRUE(mapped.material.doubleSided);
    EXPECT_EQ(mapped.warnings, Warnings{});
}

TEST(GltfMaterial, MirrorAndSolidGlassAreExact)
{
    const Mapped mirror = map({{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}}});
    EXPECT_EQ(mirror.material.scattering, Scattering::Mirror);
    EXPECT_EQ(mirror.warnings, Warnings{});
    const Mapped solid = map(glass());
    EXPECT_EQ(solid.material.scattering, Scattering::Dielectric);
    EXPECT_EQ(solid.material.ior, 1.75F);
    EXPECT_EQ(solid.warnings, Warnings{});
}

TEST(GltfMaterial, GlassHasTheCoreIndexWithoutTheExtension)
{
    json material = glass();
    material["extensions"].erase("KHR_materials_ior");
    EXPECT_EQ(map(material).material.ior, 1.5F);
}

TEST(GltfMaterial, CoreDielectricLosesItsCoat)
{
    json material = lambert();
    material.erase("extensions");
    expectIgnored(map(material).warnings, "clay", "Lambert", {"the specular coat (specularFactor 1)", "roughnessFactor 1"});
}

TEST(GltfMaterial, TheDefaultMaterialIsAMetalThatIsDrawnAsLambert)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    const Scene scene = load(builder);
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].baseColor, glm::vec3(1.0F));
    expectIgnored({scene.warnings.at(0)}, "the default material", "Lambert", {"metallicFactor 1", "roughnessFactor 1"});
}

TEST(GltfMaterial, RoughMetalsAreMappedByTheirRoughness)
{
    const auto metal = [](double metallic, double roughness) {
        return map({{"pbrMetallicRoughness", {{"metallicFactor", metallic}, {"roughnessFactor", roughness}}}, {"extensions", specular(0)}});
    };
    EXPECT_EQ(metal(1, 0.19).material.scattering, Scattering::Mirror);
    expectIgnored(metal(1, 0.19).warnings, "materials[0]", "mirror", {"roughnessFactor 0.19"});
    expectIgnored(metal(0.75, 0).warnings, "materials[0]", "mirror", {"metallicFactor 0.75"});
    EXPECT_EQ(metal(1, 0.2).material.scattering, Scattering::Lambert);
    EXPECT_EQ(metal(0.5, 0).material.scattering, Scattering::Lambert);
    expectIgnored(metal(0.5, 0.3).warnings, "materials[0]", "Lambert", {"metallicFactor 0.5", "roughnessFactor 0.3"});
}

TEST(GltfMaterial, GlassNamesEverythingItLoses)
{
    json material = glass();
    material["name"] = "bottle";
    material["pbrMetallicRoughness"] = {{"metallicFactor", 0.5}, {"roughnessFactor", 0.25}};
    material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.5;
    material["extensions"]["KHR_materials_volume"] = {{"attenuationDistance", 2}, {"attenuationColor", {1, 0, 0}}};
    material["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0.5}, {"specularColorFactor", {1, 1, 0}}};
    expectIgnored(map(material).warnings, "bottle", "solid glass",
                  {"transmissionFactor 0.5", "thin walls (thicknessFactor 0)", "attenuation in the volume", "metallicFactor 0.5",
                   "roughnessFactor 0.25", "specularFactor 0.5", "specularColorFactor"});
}

TEST(GltfMaterial, WhiteOrEndlessAttenuationIsNone)
{
    json material = glass();
    material["extensions"]["KHR_materials_volume"]["attenuationColor"] = {1, 0, 0};
    EXPECT_EQ(map(material).warnings, Warnings{});
    material["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 1}, {"attenuationDistance", 1}};
    EXPECT_EQ(map(material).warnings, Warnings{});
}

TEST(GltfMaterial, NamesTexturesAlphaAndUnknownExtensionsInOneLine)
{
    json material = lambert();
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}};
    material["normalTexture"] = {{"index", 0}};
    material["occlusionTexture"] = {{"index", 0}};
    material["emissiveTexture"] = {{"index", 0}};
    material["alphaMode"] = "MASK";
    material["extensions"]["KHR_materials_clearcoat"] = json::object();
    material["extensions"]["KHR_materials_specular"]["specularTexture"] = {{"index", 0}};
    expectIgnored(map(material, {"a"}).warnings, "clay", "Lambert",
                  {"alphaMode MASK", "baseColorTexture", "metallicRoughnessTexture", "normalTexture", "occlusionTexture", "emissiveTexture",
                   "KHR_materials_clearcoat", "specularTexture"});
}

TEST(GltfMaterial, OpaqueBlendingIsExact)
{
    json material = lambert();
    material["alphaMode"] = "BLEND";
    EXPECT_EQ(map(material).warnings, Warnings{});
    material["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.5;
    expectIgnored(map(material).warnings, "clay", "Lambert", {"alphaMode BLEND"});
    material.erase("alphaMode");
    EXPECT_EQ(map(material).warnings, Warnings{}) << "opaque materials have no alpha";
}

TEST(GltfMaterial, UnusedMaterialsSayNothing)
{
    GltfBuilder builder;
    builder.append("materials", lambert());
    builder.append("materials", json::object());
    const std::size_t mesh = builder.addTriangleMesh();
    builder.document["meshes"][mesh]["primitives"][0]["material"] = 0;
    builder.addNode({{"mesh", mesh}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(scene.warnings.size(), 1U) << "no camera";
}

}  // namespace
}  // namespace glim::test
