// The textures that a material may have: one table for the reader of glTF, the flattener and the kernels.
#ifndef GLIM_SHARED_TEXTURE_SLOTS_H
#define GLIM_SHARED_TEXTURE_SLOTS_H
#include "features.h"

#ifdef __cplusplus
#include <string_view>
#endif

GLIM_SHARED_BEGIN

// clang-format off
// SLOT(number, name, what its texels hold, the feature without which it does nothing, where glTF's material has it, what it multiplies).
//
// Texels hold a Color (RGB in sRGB), a Number or a Direction in the tangent frame. TIMES(part, factor, channels): these channels multiply
// that factor, of the part of SurfaceMaterial (access/material.glsl) and of Material (host/scene/scene.hpp). What a slot does beyond that
// is in applyTexel there, and in foldTexel (host/flatten/flatten_materials.cpp) for images of one colour.
#define GLIM_TEXTURE_SLOTS(SLOT) \
    SLOT(0, BaseColor, Color, kFeatureTextures, "pbrMetallicRoughness.baseColorTexture", TIMES(data, baseColor, rgb)) \
    SLOT(1, MetallicRoughness, Number, kFeatureTextures, "pbrMetallicRoughness.metallicRoughnessTexture", \
         TIMES(principled, metallic, b) TIMES(principled, roughness, g)) \
    SLOT(2, Normal, Direction, kFeatureNormalMaps, "normalTexture", ) \
    SLOT(3, Emissive, Color, kEmissiveSurfaces, "emissiveTexture", TIMES(data, emission, rgb)) \
    SLOT(4, Specular, Number, kFeatureTextures, "extensions.KHR_materials_specular.specularTexture", TIMES(principled, specular, a)) \
    SLOT(5, SpecularColor, Color, kFeatureTextures, "extensions.KHR_materials_specular.specularColorTexture", \
         TIMES(principled, specularColor, rgb)) \
    SLOT(6, Clearcoat, Number, kFeatureClearcoat, "extensions.KHR_materials_clearcoat.clearcoatTexture", TIMES(layers, clearcoat, r)) \
    SLOT(7, ClearcoatRoughness, Number, kFeatureClearcoat, "extensions.KHR_materials_clearcoat.clearcoatRoughnessTexture", \
         TIMES(layers, clearcoatRoughness, g)) \
    SLOT(8, ClearcoatNormal, Direction, kFeatureClearcoat, "extensions.KHR_materials_clearcoat.clearcoatNormalTexture", ) \
    SLOT(9, SheenColor, Color, kFeatureSheen, "extensions.KHR_materials_sheen.sheenColorTexture", TIMES(layers, sheenColor, rgb)) \
    SLOT(10, SheenRoughness, Number, kFeatureSheen, "extensions.KHR_materials_sheen.sheenRoughnessTexture", \
         TIMES(layers, sheenRoughness, a)) \
    SLOT(11, Anisotropy, Direction, kFeatureAnisotropy, "extensions.KHR_materials_anisotropy.anisotropyTexture", \
         TIMES(layers, anisotropy, b)) \
    SLOT(12, Iridescence, Number, kFeatureIridescence, "extensions.KHR_materials_iridescence.iridescenceTexture", \
         TIMES(layers, iridescence, r)) \
    SLOT(13, IridescenceThickness, Number, kFeatureIridescence, "extensions.KHR_materials_iridescence.iridescenceThicknessTexture", ) \
    SLOT(14, Transmission, Number, kFeatureTransmission, "extensions.KHR_materials_transmission.transmissionTexture", \
         TIMES(layers, transmission, r)) \
    SLOT(15, DiffuseTransmission, Number, kFeatureDiffuseTransmission, \
         "extensions.KHR_materials_diffuse_transmission.diffuseTransmissionTexture", TIMES(layers, diffuseTransmission, a)) \
    SLOT(16, DiffuseTransmissionColor, Color, kFeatureDiffuseTransmission, \
         "extensions.KHR_materials_diffuse_transmission.diffuseTransmissionColorTexture", TIMES(layers, diffuseTransmissionColor, rgb))
// clang-format on

#define GLIM_SLOT(number, name, holds, feature, path, times) GLIM_CONST uint kSlot##name = number;
GLIM_TEXTURE_SLOTS(GLIM_SLOT)
#undef GLIM_SLOT

#ifdef __cplusplus
enum class TexelKind { Color, Number, Direction };
struct TextureSlot {
    uint number;
    TexelKind holds;
    FeatureMask feature;
    std::string_view path;
};
inline constexpr TextureSlot kTextureSlots[] = {
#define GLIM_SLOT(number, name, holds, feature, path, times) {number, TexelKind::holds, feature, path},
    GLIM_TEXTURE_SLOTS(GLIM_SLOT)
#undef GLIM_SLOT
};
#endif

GLIM_SHARED_END
#endif
