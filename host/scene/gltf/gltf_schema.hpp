// A table of the properties that glim reads, after the schemas of glTF 2.0 and its extensions.
#pragma once

#include "shaders/shared/texture_slots.h"

#include <cfloat>
#include <cstddef>
#include <string_view>

namespace glim {

enum class JsonKind { Index, Whole, Number, Numbers, Bool, String, OneOf, Object, Array };
enum class Need { Optional, Required };  // the path's last member must exist if its parent does

constexpr double kPositive = DBL_MIN;             // as a minimum: greater than zero
constexpr double kMaxWhole = 9007199254740992.0;  // 2^53
constexpr double kMaxInt = 2147483647.0;          // what tinygltf has room for

// How far a number may be out of its range by rounding: a step of 8 bits, in which many tools keep colours and factors.
constexpr double kFileRounding = 0.004;
constexpr const char* kClamped = "numbers that rounding has put out of their range are clamped";

// How far the last row of a matrix may be from 0 0 0 1 by rounding.
constexpr double kAffineRounding = 1e-4;

struct SchemaRule {
    const char* path;  // `[]`: each element of an array, `{}`: each value of an object
    JsonKind kind;
    Need need = Need::Optional;
    const char* target = nullptr;  // Index: path of the array that is indexed; OneOf: the words, separated by ", "
    std::size_t count = 0;         // Numbers: how many
    double min = -DBL_MAX, max = DBL_MAX;
    double rounding = kFileRounding;  // Number, Numbers: what is out of range by less is clamped
    bool zeroIsNone = false;          // exporters write 0 where there is no value
};

namespace schema {

constexpr SchemaRule index(const char* path, const char* target, Need need = Need::Optional)
{
    return {path, JsonKind::Index, need, target, 0, 0, 0};
}

constexpr SchemaRule whole(const char* path, Need need = Need::Optional, double min = 0, double max = kMaxWhole)
{
    return {path, JsonKind::Whole, need, nullptr, 0, min, max};
}

constexpr SchemaRule number(const char* path, Need need = Need::Optional, double min = -DBL_MAX, double max = DBL_MAX)
{
    return {path, JsonKind::Number, need, nullptr, 0, min, max};
}

constexpr SchemaRule numbers(const char* path, std::size_t count, double min = -DBL_MAX, double max = DBL_MAX)
{
    return {path, JsonKind::Numbers, Need::Optional, nullptr, count, min, max};
}

constexpr SchemaRule exact(SchemaRule rule)
{
    rule.rounding = 0.0;
    return rule;
}

constexpr SchemaRule zeroIsNone(SchemaRule rule)
{
    rule.zeroIsNone = true;
    return rule;
}

constexpr SchemaRule oneOf(const char* path, const char* words, Need need = Need::Optional) { return {path, JsonKind::OneOf, need, words}; }

constexpr SchemaRule other(const char* path, JsonKind kind, Need need = Need::Optional) { return {path, kind, need}; }

}  // namespace schema

constexpr double kHalfPi = 1.57079632679489661923;
constexpr double kMaxYfov = 3.14;  // at pi the picture plane is infinite

// A rule comes before those whose indices point into what it checks.
constexpr SchemaRule kSchemaRules[] = {
    schema::other("asset", JsonKind::Object, Need::Required),
    schema::other("asset.version", JsonKind::String, Need::Required),
    schema::other("asset.minVersion", JsonKind::String),
    schema::other("extensionsUsed[]", JsonKind::String),
    schema::other("extensionsRequired[]", JsonKind::String),

    schema::other("buffers[].uri", JsonKind::String),
    schema::whole("buffers[].byteLength", Need::Required),
    schema::index("bufferViews[].buffer", "buffers", Need::Required),
    schema::whole("bufferViews[].byteOffset"),
    schema::whole("bufferViews[].byteLength", Need::Required),
    schema::zeroIsNone(schema::whole("bufferViews[].byteStride", Need::Optional, 1, 252)),
    schema::index("accessors[].bufferView", "bufferViews"),
    schema::whole("accessors[].byteOffset"),
    schema::whole("accessors[].componentType", Need::Required, 5120, 5126),
    schema::whole("accessors[].count", Need::Required),  // 0 is refused where the accessor is read
    schema::oneOf("accessors[].type", "SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4", Need::Required),
    schema::other("accessors[].normalized", JsonKind::Bool),
    schema::whole("accessors[].sparse.count", Need::Required, 0, kMaxInt),
    schema::other("accessors[].sparse.indices", JsonKind::Object, Need::Required),
    schema::index("accessors[].sparse.indices.bufferView", "bufferViews", Need::Required),
    schema::whole("accessors[].sparse.indices.byteOffset", Need::Optional, 0, kMaxInt),
    schema::whole("accessors[].sparse.indices.componentType", Need::Required, 5121, 5125),
    schema::other("accessors[].sparse.values", JsonKind::Object, Need::Required),
    schema::index("accessors[].sparse.values.bufferView", "bufferViews", Need::Required),
    schema::whole("accessors[].sparse.values.byteOffset", Need::Optional, 0, kMaxInt),

    schema::other("images[].name", JsonKind::String),
    schema::other("images[].uri", JsonKind::String),
    schema::other("images[].mimeType", JsonKind::String),
    schema::index("images[].bufferView", "bufferViews"),
    schema::other("samplers", JsonKind::Array),
    schema::zeroIsNone(schema::whole("samplers[].magFilter", Need::Optional, -kMaxInt, kMaxInt)),
    schema::whole("samplers[].minFilter", Need::Optional, -kMaxInt, kMaxInt),
    schema::whole("samplers[].wrapS", Need::Optional, -kMaxInt, kMaxInt),
    schema::whole("samplers[].wrapT", Need::Optional, -kMaxInt, kMaxInt),
    schema::other("textures[].name", JsonKind::String),
    schema::index("textures[].source", "images"),
    schema::index("textures[].sampler", "samplers"),
    schema::index("textures[].extensions.EXT_texture_avif.source", "images"),
    schema::index("textures[].extensions.EXT_texture_webp.source", "images"),
    schema::index("textures[].extensions.MSFT_texture_dds.source", "images"),
    schema::index("textures[].extensions.KHR_texture_basisu.source", "images"),

    schema::other("materials[].name", JsonKind::String),
    schema::numbers("materials[].pbrMetallicRoughness.baseColorFactor", 4, 0, 1),
    schema::number("materials[].pbrMetallicRoughness.metallicFactor", Need::Optional, 0, 1),
    schema::number("materials[].pbrMetallicRoughness.roughnessFactor", Need::Optional, 0, 1),
    schema::numbers("materials[].emissiveFactor", 3, 0),
    schema::oneOf("materials[].alphaMode", "OPAQUE, MASK, BLEND"),
    schema::number("materials[].alphaCutoff", Need::Optional, 0),
    schema::other("materials[].doubleSided", JsonKind::Bool),
    schema::other("materials[].extensions{}", JsonKind::Object),
    schema::number("materials[].extensions.KHR_materials_emissive_strength.emissiveStrength", Need::Optional, 0),
    schema::number("materials[].extensions.KHR_materials_ior.ior", Need::Optional, 0),
    schema::number("materials[].extensions.KHR_materials_specular.specularFactor", Need::Optional, 0, 1),
    schema::numbers("materials[].extensions.KHR_materials_specular.specularColorFactor", 3, 0),
    schema::number("materials[].extensions.KHR_materials_transmission.transmissionFactor", Need::Optional, 0, 1),
    schema::number("materials[].extensions.KHR_materials_volume.thicknessFactor", Need::Optional, 0),
    schema::zeroIsNone(schema::number("materials[].extensions.KHR_materials_volume.attenuationDistance", Need::Optional, kPositive)),
    schema::numbers("materials[].extensions.KHR_materials_volume.attenuationColor", 3, 0, 1),
    schema::number("materials[].extensions.KHR_materials_dispersion.dispersion", Need::Optional, 0),
    schema::number("materials[].extensions.KHR_materials_scatter.scatterStrengthFactor", Need::Optional, 0, 1),
    schema::number("materials[].extensions.KHR_materials_scatter.scatterFactor", Need::Optional, 0, 1),
    schema::numbers("materials[].extensions.KHR_materials_scatter.multiscatterColorFactor", 3, 0, 1),
    schema::number("materials[].extensions.KHR_materials_scatter.scatterAnisotropy", Need::Optional, -1, 1),
    schema::numbers("materials[].extensions.KHR_materials_volume_scatter.multiscatterColor", 3, 0, 1),
    schema::numbers("materials[].extensions.KHR_materials_volume_scatter.multiscatterColorFactor", 3, 0, 1),
    schema::number("materials[].extensions.KHR_materials_volume_scatter.scatterAnisotropy", Need::Optional, -1, 1),
    schema::numbers("materials[].extensions.KHR_materials_subsurface.scatterColor", 3, 0, 1),
    schema::zeroIsNone(schema::number("materials[].extensions.KHR_materials_subsurface.scatterDistance", Need::Optional, kPositive)),
    schema::numbers("materials[].extensions.KHR_materials_sss.scatterColor", 3, 0, 1),
    schema::zeroIsNone(schema::number("materials[].extensions.KHR_materials_sss.scatterDistance", Need::Optional, kPositive)),
    schema::numbers("materials[].extensions.KHR_materials_sss.subsurfaceColor", 3, 0, 1),
    schema::number("materials[].extensions.KHR_materials_diffuse_transmission.diffuseTransmissionFactor", Need::Optional, 0, 1),
    schema::numbers("materials[].extensions.KHR_materials_diffuse_transmission.diffuseTransmissionColorFactor", 3, 0, 1),
    schema::number("materials[].extensions.KHR_materials_clearcoat.clearcoatFactor", Need::Optional, 0, 1),
    schema::number("materials[].extensions.KHR_materials_clearcoat.clearcoatRoughnessFactor", Need::Optional, 0, 1),
    schema::numbers("materials[].extensions.KHR_materials_sheen.sheenColorFactor", 3, 0, 1),
    schema::number("materials[].extensions.KHR_materials_sheen.sheenRoughnessFactor", Need::Optional, 0, 1),
    schema::number("materials[].extensions.KHR_materials_anisotropy.anisotropyStrength", Need::Optional, 0, 1),
    schema::number("materials[].extensions.KHR_materials_anisotropy.anisotropyRotation"),
    schema::number("materials[].extensions.KHR_materials_iridescence.iridescenceFactor", Need::Optional, 0, 1),
    schema::number("materials[].extensions.KHR_materials_iridescence.iridescenceIor", Need::Optional, 1),
    schema::number("materials[].extensions.KHR_materials_iridescence.iridescenceThicknessMinimum", Need::Optional, 0),
    schema::number("materials[].extensions.KHR_materials_iridescence.iridescenceThicknessMaximum", Need::Optional, 0),
    schema::numbers("materials[].extensions.KHR_materials_pbrSpecularGlossiness.diffuseFactor", 4, 0, 1),
    schema::numbers("materials[].extensions.KHR_materials_pbrSpecularGlossiness.specularFactor", 3, 0, 1),
    schema::number("materials[].extensions.KHR_materials_pbrSpecularGlossiness.glossinessFactor", Need::Optional, 0, 1),
    schema::other("extensions.KHR_materials_variants.variants", JsonKind::Array, Need::Required),
    schema::other("extensions.KHR_materials_variants.variants[].name", JsonKind::String, Need::Required),

    schema::other("meshes[].name", JsonKind::String),
    schema::other("meshes[].primitives", JsonKind::Array, Need::Required),
    schema::other("meshes[].primitives[].attributes", JsonKind::Object, Need::Required),
    schema::index("meshes[].primitives[].attributes{}", "accessors"),
    schema::index("meshes[].primitives[].indices", "accessors"),
    schema::index("meshes[].primitives[].material", "materials"),
    schema::whole("meshes[].primitives[].mode", Need::Optional, 0, 6),
    schema::index("meshes[].primitives[].extensions.KHR_draco_mesh_compression.bufferView", "bufferViews", Need::Required),
    schema::other("meshes[].primitives[].extensions.KHR_draco_mesh_compression.attributes", JsonKind::Object, Need::Required),
    schema::whole("meshes[].primitives[].extensions.KHR_draco_mesh_compression.attributes{}", Need::Optional, 0, kMaxInt),
    schema::index("meshes[].primitives[].extensions.KHR_materials_variants.mappings[].material", "materials", Need::Required),
    schema::index("meshes[].primitives[].extensions.KHR_materials_variants.mappings[].variants[]",
                  "extensions.KHR_materials_variants.variants"),
    schema::index("meshes[].primitives[].targets[]{}", "accessors"),
    schema::number("meshes[].weights[]"),

    schema::other("cameras[].name", JsonKind::String),
    schema::oneOf("cameras[].type", "perspective, orthographic", Need::Required),
    schema::exact(schema::number("cameras[].perspective.yfov", Need::Required, kPositive, kMaxYfov)),
    schema::zeroIsNone(schema::number("cameras[].perspective.aspectRatio", Need::Optional, kPositive)),
    schema::number("cameras[].perspective.znear", Need::Required, 0),  // nothing is clipped
    schema::number("cameras[].orthographic.xmag", Need::Required),     // negative: mirrored; the reader refuses 0
    schema::number("cameras[].orthographic.ymag", Need::Required),
    schema::number("cameras[].orthographic.znear", Need::Required),
    schema::number("cameras[].orthographic.zfar", Need::Required),
    schema::other("extensions.KHR_lights_punctual.lights", JsonKind::Array, Need::Required),
    schema::other("extensions.KHR_lights_punctual.lights[].name", JsonKind::String),
    schema::oneOf("extensions.KHR_lights_punctual.lights[].type", "point, directional, spot", Need::Required),
    schema::numbers("extensions.KHR_lights_punctual.lights[].color", 3, 0),
    schema::number("extensions.KHR_lights_punctual.lights[].intensity", Need::Optional, 0),
    schema::zeroIsNone(schema::number("extensions.KHR_lights_punctual.lights[].range", Need::Optional, kPositive)),
    schema::number("extensions.KHR_lights_punctual.lights[].spot.innerConeAngle", Need::Optional, 0, kHalfPi),
    schema::number("extensions.KHR_lights_punctual.lights[].spot.outerConeAngle", Need::Optional, kPositive, kHalfPi),

    schema::other("extensions.EXT_lights_image_based.lights", JsonKind::Array, Need::Required),
    schema::number("extensions.EXT_lights_image_based.lights[].intensity", Need::Optional, 0),
    schema::numbers("extensions.EXT_lights_image_based.lights[].rotation", 4),
    schema::other("extensions.EXT_lights_image_based.lights[].specularImages", JsonKind::Array, Need::Required),
    schema::index("extensions.EXT_lights_image_based.lights[].specularImages[][]", "images"),

    schema::other("nodes[].name", JsonKind::String),
    schema::index("nodes[].children[]", "nodes"),
    schema::index("nodes[].mesh", "meshes"),
    schema::index("nodes[].camera", "cameras"),
    schema::index("nodes[].skin", "skins"),
    schema::number("nodes[].weights[]"),
    schema::index("nodes[].extensions.KHR_lights_punctual.light", "extensions.KHR_lights_punctual.lights", Need::Required),
    schema::other("nodes[].extensions.KHR_node_visibility.visible", JsonKind::Bool),
    schema::index("nodes[].extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION", "accessors"),
    schema::index("nodes[].extensions.EXT_mesh_gpu_instancing.attributes.ROTATION", "accessors"),
    schema::index("nodes[].extensions.EXT_mesh_gpu_instancing.attributes.SCALE", "accessors"),
    schema::numbers("nodes[].matrix", 16),
    schema::numbers("nodes[].translation", 3),
    schema::numbers("nodes[].rotation", 4),
    schema::numbers("nodes[].scale", 3),
    schema::exact(schema::number("nodes[].extras.sphere.radius", Need::Required, 0)),
    schema::index("nodes[].extras.sphere.material", "materials"),
    schema::other("materials[].extras.shadowCatcher", JsonKind::Bool),
    schema::other("skins[].name", JsonKind::String),
    schema::other("skins[].joints", JsonKind::Array, Need::Required),
    schema::index("skins[].joints[]", "nodes"),
    schema::index("skins[].inverseBindMatrices", "accessors"),
    schema::other("animations[].name", JsonKind::String),
    schema::other("animations[].samplers", JsonKind::Array, Need::Required),
    schema::index("animations[].samplers[].input", "accessors", Need::Required),
    schema::index("animations[].samplers[].output", "accessors", Need::Required),
    schema::oneOf("animations[].samplers[].interpolation", "LINEAR, STEP, CUBICSPLINE"),
    schema::other("animations[].channels", JsonKind::Array, Need::Required),
    schema::whole("animations[].channels[].sampler", Need::Required),
    schema::other("animations[].channels[].target", JsonKind::Object, Need::Required),
    schema::index("animations[].channels[].target.node", "nodes"),
    schema::oneOf("animations[].channels[].target.path", "translation, rotation, scale, weights, pointer", Need::Required),
    schema::other("animations[].channels[].target.extensions.KHR_animation_pointer.pointer", JsonKind::String, Need::Required),
    schema::other("scenes[].name", JsonKind::String),
    schema::index("scenes[].nodes[]", "nodes"),
    schema::index("scenes[].extensions.EXT_lights_image_based.light", "extensions.EXT_lights_image_based.lights", Need::Required),
    schema::index("scene", "scenes"),
};

constexpr std::string_view kGlossinessColor = "extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture";
constexpr std::string_view kGlossinessSpecular = "extensions.KHR_materials_pbrSpecularGlossiness.specularGlossinessTexture";

constexpr std::string_view kScatterStrengthTexture = "extensions.KHR_materials_scatter.scatterStrengthTexture";
constexpr std::string_view kScatterDraftTexture = "extensions.KHR_materials_scatter.scatterTexture";
constexpr std::string_view kScatterColorTexture = "extensions.KHR_materials_scatter.multiscatterColorTexture";

// Where materials refer to textures. Each may have texture coordinates and KHR_texture_transform.
// clang-format off
constexpr std::string_view kTexturePaths[] = {
#define SLOT(number, name, holds, feature, path, times) path,
    GLIM_TEXTURE_SLOTS(SLOT)
#undef SLOT
    kGlossinessColor, kGlossinessSpecular, kScatterStrengthTexture, kScatterDraftTexture, kScatterColorTexture,
    "occlusionTexture", "extensions.KHR_materials_volume.thicknessTexture",
};
// clang-format on
constexpr SchemaRule kTextureRules[] = {
    schema::index(".index", "textures", Need::Required),
    schema::whole(".texCoord", Need::Optional, 0, kMaxInt),
    schema::number(".scale"),
    schema::numbers(".extensions.KHR_texture_transform.offset", 2),
    schema::numbers(".extensions.KHR_texture_transform.scale", 2),
    schema::number(".extensions.KHR_texture_transform.rotation"),
    schema::whole(".extensions.KHR_texture_transform.texCoord", Need::Optional, 0, kMaxInt),
};

// What the second one adds, version 1 of attributes and the filter COLOR, is read under both names.
constexpr const char* kMeshoptExtensions[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
constexpr SchemaRule kMeshoptViewRules[] = {
    schema::index(".buffer", "buffers", Need::Required),
    schema::whole(".byteOffset"),
    schema::whole(".byteLength", Need::Required, 1),
    schema::whole(".byteStride", Need::Required, 1, 256),
    schema::whole(".count", Need::Required, 1),
    schema::oneOf(".mode", "ATTRIBUTES, TRIANGLES, INDICES", Need::Required),
    schema::oneOf(".filter", "NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL, COLOR"),
};
constexpr SchemaRule kMeshoptBufferRules[] = {schema::other(".fallback", JsonKind::Bool)};

}  // namespace glim
