// Which glTF material becomes which of glim's, and the lines that say what is left out.
#include "host/error.hpp"
#include "host/flatten/flatten_materials.hpp"
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glim::test {
namespace {

using nlohmann::json;

struct Mapped {
    Material material;
    std::vector<Message> warnings;
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

using Messages = std::vector<Message>;

// Those that speak of materials: a map of one triangle has no light, which is said too.
Messages ofMaterials(const Messages& messages)
{
    Messages kept;
    std::ranges::copy_if(messages, std::back_inserter(kept), [](const Message& said) { return said.place.starts_with("materials[0]"); });
    return kept;
}

TEST(GltfMaterial, LambertIsADielectricWithoutReflection)
{
    const Mapped mapped = map(lambert());
    EXPECT_EQ(ofMaterials(mapped.warnings), Messages{});
    EXPECT_EQ(chooseMaterialType(mapped.material), kLambert);
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
    EXPECT_EQ(mapped.warnings, Messages{}) << "a lamp is a light";
}

TEST(GltfMaterial, TheSimplestLobeIsChosen)
{
    const auto lobe = [](double metallic, double roughness, double specularFactor) {
        return chooseMaterialType(map({{"pbrMetallicRoughness", {{"metallicFactor", metallic}, {"roughnessFactor", roughness}}},
                                       {"extensions", specular(specularFactor)}})
                                      .material);
    };
    EXPECT_EQ(lobe(1, 0, 1), kMirror);
    EXPECT_EQ(lobe(1, 0.0316, 0), kMirror);
    EXPECT_EQ(lobe(1, 0.0317, 1), kPrincipled);
    EXPECT_EQ(lobe(0.99, 0, 0), kPrincipled);
    EXPECT_EQ(lobe(0, 0, 0), kLambert);
    EXPECT_EQ(lobe(0, 0, 0.1), kPrincipled);
    EXPECT_EQ(chooseMaterialType(map(glass()).material), kDielectric);
}

TEST(GltfMaterial, SolidGlassIsExact)
{
    const Mapped solid = map(glass());
    EXPECT_TRUE(solid.material.solid);
    EXPECT_EQ(solid.material.transmission, 1.0F);
    EXPECT_EQ(solid.material.ior, 1.75F);
    EXPECT_EQ(ofMaterials(solid.warnings), Messages{});
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
    EXPECT_FALSE(isTextured(material));
}

// KHR_materials_volume: the share (attenuationColor) is left after attenuationDistance.
TEST(GltfMaterial, AttenuationIsAbsorptionPerMetre)
{
    json material = glass();
    material["extensions"]["KHR_materials_volume"]["attenuationColor"] = {1, 0, 0.5};
    EXPECT_EQ(map(material).material.absorption, glm::vec3(0.0F)) << "without a distance it is endless";
    material["extensions"]["KHR_materials_volume"]["attenuationDistance"] = 2;
    const glm::vec3 absorption = map(material).material.absorption;
    EXPECT_EQ(absorption.r, 0.0F);
    EXPECT_TRUE(std::isfinite(absorption.g));
    EXPECT_GT(absorption.g, 6.0F) << "black, as nearly as float can tell";
    EXPECT_FLOAT_EQ(absorption.b, 0.5F * std::log(2.0F));
    EXPECT_EQ(ofMaterials(map(material).warnings), Messages{});
}

// Half of the light is left after 2 m, of which the extension says how much is scattered.
json scatteringGlass(const std::string& extension, const json& properties)
{
    json material = glass();
    material["extensions"]["KHR_materials_volume"]["attenuationColor"] = {0.5, 0.5, 0.5};
    material["extensions"]["KHR_materials_volume"]["attenuationDistance"] = 2;
    material["extensions"][extension] = properties;
    return material;
}

// The albedo of one scattering by hand, of the colours .5, 1 and 0: s = .2971383, 0, 1.
TEST(GltfMaterial, TheColourOfAVolumeDividesItsAttenuation)
{
    const float extinction = 0.5F * std::log(2.0F);
    const auto expectDivided = [&](const char* extension, const json& properties, float halfGrey, float anisotropy) {
        const Mapped mapped = map(scatteringGlass(extension, properties));
        const Material& m = mapped.material;
        EXPECT_EQ(ofMaterials(mapped.warnings), Messages{}) << extension;
        EXPECT_NEAR(m.scattering.r, extinction * halfGrey, 2e-6F) << extension;
        EXPECT_NEAR(m.absorption.r, extinction * (1.0F - halfGrey), 2e-6F) << extension;
        EXPECT_EQ(m.absorption.g, 0.0F) << extension;
        EXPECT_FLOAT_EQ(m.scattering.g, extinction) << extension;
        EXPECT_EQ(m.scattering.b, 0.0F) << extension;
        EXPECT_EQ(m.scatterAnisotropy, anisotropy) << extension;
    };
    const json color = {0.5, 1, 0};
    constexpr float kSquare = 0.2971383F * 0.2971383F;
    expectDivided("KHR_materials_volume_scatter", {{"multiscatterColor", color}, {"scatterAnisotropy", 0.5}}, 1.0F - kSquare, 0.5F);
    expectDivided("KHR_materials_volume_scatter", {{"multiscatterColorFactor", color}}, 1.0F - kSquare, 0.0F);
    expectDivided("KHR_materials_sss", {{"subsurfaceColor", color}}, 1.0F - kSquare, 0.0F);
    expectDivided("KHR_materials_scatter", {{"scatterStrengthFactor", 1}, {"multiscatterColorFactor", color}, {"scatterAnisotropy", 0.5}},
                  (1.0F - kSquare) / (1.0F - 0.5F * kSquare), 0.5F);
    expectDivided("KHR_materials_scatter", {{"scatterFactor", 1}, {"multiscatterColorFactor", color}}, 1.0F - kSquare, 0.0F);
}

TEST(GltfMaterial, TheStrengthOfScatteringScalesItsColour)
{
    const auto scatteringOf = [](const json& properties) {
        return map(scatteringGlass("KHR_materials_scatter", properties)).material.scattering;
    };
    EXPECT_EQ(scatteringOf(json::object()), glm::vec3(0.0F)) << "the default strength is 0";
    EXPECT_EQ(scatteringOf({{"scatterStrengthFactor", 0.5}}),
              scatteringOf({{"scatterStrengthFactor", 1}, {"multiscatterColorFactor", {0.5, 0.5, 0.5}}}));
    const Mapped forwards = map(scatteringGlass("KHR_materials_scatter", {{"scatterStrengthFactor", 1}, {"scatterAnisotropy", 1}}));
    EXPECT_EQ(forwards.material.scatterAnisotropy, 0.999F) << "1 would not scatter at all";
}

TEST(GltfMaterial, ACoefficientOfScatteringComesBesideTheAttenuation)
{
    for (const char* draft : {"KHR_materials_subsurface", "KHR_materials_sss"}) {
        const Mapped mapped = map(scatteringGlass(draft, {{"scatterColor", {0.25, 1, 0.5}}, {"scatterDistance", 4}}));
        EXPECT_EQ(ofMaterials(mapped.warnings), Messages{});
        EXPECT_FLOAT_EQ(mapped.material.absorption.r, 0.5F * std::log(2.0F));
        EXPECT_FLOAT_EQ(mapped.material.scattering.r, 0.25F * std::log(4.0F));
        EXPECT_EQ(mapped.material.scattering.g, 0.0F);
        EXPECT_FLOAT_EQ(mapped.material.scattering.b, 0.25F * std::log(2.0F));
    }
}

TEST(GltfMaterial, ThinWallsScatterWhatTheyTransmit)
{
    json material = scatteringGlass("KHR_materials_scatter",
                                    {{"scatterStrengthFactor", 0.5}, {"scatterAnisotropy", -1}, {"multiscatterColorFactor", {0.5, 1, 0}}});
    material["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 0;
    const Mapped mapped = map(material);
    EXPECT_EQ(ofMaterials(mapped.warnings), Messages{});
    EXPECT_TRUE(mapped.material.scattersThin);
    EXPECT_EQ(mapped.material.diffuseTransmission, 0.5F);
    EXPECT_EQ(mapped.material.diffuseTransmissionColor, glm::vec3(0.5F, 1.0F, 0.0F));
    EXPECT_EQ(mapped.material.scatterAnisotropy, -1.0F);
    material["extensions"].erase("KHR_materials_transmission");
    expectMessage(findWarning(map(material).warnings, MessageId::ExtensionIgnored), MessageId::ExtensionIgnored,
                  {.place = "materials[0]", .value = "KHR_materials_scatter"});
}

TEST(GltfMaterial, SmoothSolidGlassAloneIsTheSimpleLobe)
{
    EXPECT_EQ(chooseMaterialType(map(glass()).material), kDielectric);
    const std::pair<const char*, json> others[] = {
        {"/pbrMetallicRoughness/roughnessFactor", 0.25},
        {"/pbrMetallicRoughness/metallicFactor", 0.5},
        {"/extensions/KHR_materials_transmission/transmissionFactor", 0.5},
        {"/extensions/KHR_materials_volume/thicknessFactor", 0},
        {"/extensions/KHR_materials_specular/specularFactor", 0.5},
        {"/extensions/KHR_materials_clearcoat/clearcoatFactor", 0.5},
    };
    for (const auto& [place, value] : others) {
        json material = glass();
        material[json::json_pointer(place)] = value;
        EXPECT_EQ(chooseMaterialType(map(material).material), kPrincipled) << place;
    }
}

TEST(GltfMaterial, ReadsEveryLayer)
{
    const json extensions = {
        {"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}, {"clearcoatRoughnessFactor", 0.25}}},
        {"KHR_materials_sheen", {{"sheenColorFactor", {0.1, 0.2, 0.3}}, {"sheenRoughnessFactor", 0.4}}},
        {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.6}, {"anisotropyRotation", -1.5}}},
        {"KHR_materials_iridescence",
         {{"iridescenceFactor", 0.7}, {"iridescenceIor", 1.8}, {"iridescenceThicknessMinimum", 10}, {"iridescenceThicknessMaximum", 20}}},
        {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.8}, {"diffuseTransmissionColorFactor", {0.5, 1, 0}}}},
        {"KHR_materials_volume", {{"thicknessFactor", 1}}},
        {"KHR_materials_dispersion", {{"dispersion", 0.9}}}};
    const Mapped mapped = map({{"extensions", extensions}});
    const Material& m = mapped.material;
    EXPECT_EQ(ofMaterials(mapped.warnings), Messages{});
    EXPECT_EQ(m.clearcoat, 0.5F);
    EXPECT_EQ(m.clearcoatRoughness, 0.25F);
    EXPECT_EQ(m.sheenColor, glm::vec3(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(m.sheenRoughness, 0.4F);
    EXPECT_EQ(m.anisotropy, 0.6F);
    EXPECT_EQ(m.anisotropyRotation, -1.5F);
    EXPECT_EQ(m.iridescence, 0.7F);
    EXPECT_EQ(m.iridescenceIor, 1.8F);
    EXPECT_EQ(m.iridescenceThicknessMinimum, 10.0F);
    EXPECT_EQ(m.iridescenceThicknessMaximum, 20.0F);
    EXPECT_EQ(m.diffuseTransmission, 0.8F);
    EXPECT_EQ(m.diffuseTransmissionColor, glm::vec3(0.5F, 1.0F, 0.0F));
    EXPECT_TRUE(m.solid);
    EXPECT_EQ(m.dispersion, 0.9F);
}

TEST(GltfMaterial, SpecularGlossinessReplacesMetallicRoughness)
{
    const json glossiness = {{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}}, {"specularFactor", {0.5, 0.6, 0.7}}, {"glossinessFactor", 0.75}};
    const Material m = map({{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0.9}}},
                            {"extensions", {{"KHR_materials_pbrSpecularGlossiness", glossiness}}}})
                           .material;
    EXPECT_TRUE(m.glossy);
    EXPECT_EQ(m.metallic, 0.0F);
    EXPECT_EQ(m.baseColor, glm::vec3(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(m.alpha, 0.4F);
    EXPECT_EQ(m.specularColor, glm::vec3(0.5F, 0.6F, 0.7F));
    EXPECT_EQ(m.roughness, 0.75F) << "the glossiness, until it is flattened";
    EXPECT_EQ(m.ior, 0.0F);
}

TEST(GltfMaterial, UnlitEmitsNothing)
{
    const Material m = map({{"emissiveFactor", {1, 1, 1}}, {"extensions", {{"KHR_materials_unlit", json::object()}}}}).material;
    EXPECT_TRUE(m.unlit);
    EXPECT_EQ(m.emission, glm::vec3(0.0F));
    EXPECT_EQ(chooseMaterialType(m), kUnlit);
}

TEST(GltfMaterial, VariantsChooseAmongMaterials)
{
    GltfBuilder builder;
    builder.append("materials", lambert());
    json red = lambert();
    red["name"] = "red";
    builder.append("materials", red);
    builder.document["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "day"}}, {{"name", "night"}}};
    const std::size_t mesh = builder.addTriangleMesh();
    json& primitive = builder.document["meshes"][mesh]["primitives"][0];
    primitive["material"] = 0;
    primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {1}}}};
    builder.addNode({{"mesh", mesh}});
    LoadOptions options;
    const auto getMaterial = [&](const std::string& variant) {
        options.variant = variant;
        const Scene scene = load(builder, options);
        return scene.materials[scene.meshes[0].material].name;
    };
    EXPECT_EQ(getMaterial(""), "clay");
    EXPECT_EQ(getMaterial("day"), "clay");
    EXPECT_EQ(getMaterial("night"), "red");
    expectRefusal<InputError>([&] { getMaterial("noon"); }, MessageId::UnknownName, {.value = "noon", .expected = "\"day\", \"night\""});
}

TEST(GltfMaterial, OneLineForEachExtensionThatIsIgnored)
{
    GltfBuilder builder;
    for (int i = 0; i < 5; ++i) {
        json material = lambert();
        material["extensions"]["VENDOR_toon"] = json::object();
        builder.append("materials", material);
        const std::size_t mesh = builder.addTriangleMesh();
        builder.document["meshes"][mesh]["primitives"][0]["material"] = i;
        builder.addNode({{"mesh", mesh}});
    }
    const Messages messages = ofMaterials(load(builder).warnings);
    ASSERT_EQ(messages.size(), 1U);
    expectMessage(
        messages[0], MessageId::ExtensionIgnored,
        {.place = "materials[0] (\"clay\"), materials[1] (\"clay\"), materials[2] (\"clay\") and 2 more", .value = "VENDOR_toon"});
}

TEST(GltfMaterial, UnusedMaterialsSayNothing)
{
    GltfBuilder builder;
    builder.append("materials", lambert());
    json other = lambert();
    other["extensions"]["VENDOR_toon"] = json::object();
    builder.append("materials", other);
    const std::size_t mesh = builder.addTriangleMesh();
    builder.document["meshes"][mesh]["primitives"][0]["material"] = 0;
    builder.addNode({{"mesh", mesh}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.materials.size(), 2U);
    EXPECT_FALSE(hasWarning(scene.warnings, MessageId::ExtensionIgnored));
}

}  // namespace
}  // namespace glim::test
