// Which glTF material becomes which of glim's, and the lines that say what is left out.
#include "host/flatten/flatten_materials.hpp"
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

Mapped map(const json& material)
{
    GltfBuilder builder;
    builder.append("materials", material);
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

using Lines = std::vector<std::string>;

bool mentions(const Lines& lines, const std::string& part)
{
    return std::any_of(lines.begin(), lines.end(), [&part](const std::string& line) { return line.find(part) != std::string::npos; });
}

// Lines that speak of materials: a map of one triangle has no light, which is said too.
Lines ofMaterials(const Lines& lines)
{
    Lines kept;
    std::copy_if(lines.begin(), lines.end(), std::back_inserter(kept),
                 [](const std::string& line) { return line.find("materials[0]") != std::string::npos; });
    return kept;
}

TEST(GltfMaterial, LambertIsADielectricWithoutReflection)
{
    const Mapped mapped = map(lambert());
    EXPECT_EQ(ofMaterials(mapped.warnings), Lines{});
    EXPECT_EQ(lobeOf(mapped.material), kLambert);
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
    EXPECT_EQ(mapped.warnings, Lines{}) << "a lamp is a light";
}

TEST(GltfMaterial, TheSimplestLobeIsChosen)
{
    const auto lobe = [](double metallic, double roughness, double specularFactor) {
        return lobeOf(map({{"pbrMetallicRoughness", {{"metallicFactor", metallic}, {"roughnessFactor", roughness}}},
                           {"extensions", specular(specularFactor)}})
                          .material);
    };
    EXPECT_EQ(lobe(1, 0, 1), kMirror);
    EXPECT_EQ(lobe(1, 0.0316, 0), kMirror);
    EXPECT_EQ(lobe(1, 0.0317, 1), kPrincipled);
    EXPECT_EQ(lobe(0.99, 0, 0), kPrincipled);
    EXPECT_EQ(lobe(0, 0, 0), kLambert);
    EXPECT_EQ(lobe(0, 0, 0.1), kPrincipled);
    EXPECT_EQ(lobeOf(map(glass()).material), kDielectric);
}

TEST(GltfMaterial, SolidGlassIsExact)
{
    const Mapped solid = map(glass());
    EXPECT_TRUE(solid.material.glass);
    EXPECT_EQ(solid.material.ior, 1.75F);
    EXPECT_EQ(ofMaterials(solid.warnings), Lines{});
    json material = glass();
    material["extensions"].erase("KHR_materials_ior");
    EXPECT_EQ(map(material).material.ior, 1.5F) << "the core's";
}

TEST(GltfMaterial, TheDefaultsAreThoseOfTheSpecification)
{
    const Material material = map(json::object()).material;
    EXPECT_EQ(material.baseColor, glm::vec3(1.0F));
    EXPECT_EQ(material.metallic, 1.0F);
    EXPECT_EQ(material.roughness, 1.0F);
    EXPECT_EQ(material.ior, 1.5F);
    EXPECT_EQ(material.specular, 1.0F);
    EXPECT_EQ(material.specularColor, glm::vec3(1.0F));
    EXPECT_EQ(material.alphaMode, AlphaMode::Opaque);
    EXPECT_EQ(material.alphaCutoff, 0.5F);
    EXPECT_EQ(material.normalScale, 1.0F);
    for (const auto* texture : texturesOf(material)) {
        EXPECT_FALSE(texture->has_value());
    }
}

TEST(GltfMaterial, SaysWhatGlassLoses)
{
    json material = glass();
    material["pbrMetallicRoughness"] = {{"metallicFactor", 0.5}, {"roughnessFactor", 0.25}};
    material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.5;
    material["extensions"]["KHR_materials_volume"] = {{"attenuationDistance", 2}, {"attenuationColor", {1, 0, 0}}};
    const Lines lines = ofMaterials(map(material).warnings);
    for (const char* part : {"partial transmission", "thin-walled", "attenuation", "rough glass", "metallic"}) {
        EXPECT_TRUE(mentions(lines, part)) << part;
    }
    EXPECT_EQ(lines.size(), 5U);
}

TEST(GltfMaterial, WhiteOrEndlessAttenuationIsNone)
{
    json material = glass();
    material["extensions"]["KHR_materials_volume"]["attenuationColor"] = {1, 0, 0};
    EXPECT_EQ(ofMaterials(map(material).warnings), Lines{});
    material["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 1}, {"attenuationDistance", 1}};
    EXPECT_EQ(ofMaterials(map(material).warnings), Lines{});
}

TEST(GltfMaterial, OneLineForEachExtensionThatIsIgnored)
{
    GltfBuilder builder;
    for (int i = 0; i < 5; ++i) {
        json material = lambert();
        material["extensions"]["KHR_materials_sheen"] = json::object();
        builder.append("materials", material);
        const std::size_t mesh = builder.addTriangleMesh();
        builder.document["meshes"][mesh]["primitives"][0]["material"] = i;
        builder.addNode({{"mesh", mesh}});
    }
    const Lines lines = ofMaterials(load(builder).warnings);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0],
              "KHR_materials_sheen is ignored: materials[0] (\"clay\"), materials[1] (\"clay\"), materials[2] (\"clay\") and 2 more");
}

TEST(GltfMaterial, UnusedMaterialsSayNothing)
{
    GltfBuilder builder;
    builder.append("materials", lambert());
    json other = lambert();
    other["extensions"]["KHR_materials_sheen"] = json::object();
    builder.append("materials", other);
    const std::size_t mesh = builder.addTriangleMesh();
    builder.document["meshes"][mesh]["primitives"][0]["material"] = 0;
    builder.addNode({{"mesh", mesh}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.materials.size(), 2U);
    EXPECT_FALSE(mentions(scene.warnings, "KHR_materials_sheen"));
}

}  // namespace
}  // namespace glim::test
