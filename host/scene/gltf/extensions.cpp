#include "host/scene/gltf/extensions.hpp"

#include <algorithm>
#include <string_view>

namespace glim {
namespace {

struct Extension {
    std::string_view name;  // after an asterisk: a part of names
    ExtensionEffect effect;
};

// The first that fits counts.
constexpr Extension kExtensions[] = {
    {"EXT_lights_image_based", ExtensionEffect::Drawn},
    {"EXT_mesh_gpu_instancing", ExtensionEffect::Drawn},
    {"EXT_meshopt_compression", ExtensionEffect::Drawn},
    {"EXT_texture_avif", ExtensionEffect::Looks},  // an image that cannot be read, which may be drawn grey
    {"EXT_texture_webp", ExtensionEffect::Drawn},
    {"KHR_animation_pointer", ExtensionEffect::Drawn},
    {"KHR_draco_mesh_compression", ExtensionEffect::Drawn},
    {"KHR_gaussian_splatting", ExtensionEffect::Looks},  // drawn as points
    {"KHR_lights_punctual", ExtensionEffect::Drawn},
    {"KHR_materials_anisotropy", ExtensionEffect::Drawn},
    {"KHR_materials_clearcoat", ExtensionEffect::Drawn},
    {"KHR_materials_diffuse_transmission", ExtensionEffect::Drawn},
    {"KHR_materials_dispersion", ExtensionEffect::Drawn},
    {"KHR_materials_emissive_strength", ExtensionEffect::Drawn},
    {"KHR_materials_ior", ExtensionEffect::Drawn},
    {"KHR_materials_iridescence", ExtensionEffect::Drawn},
    {"KHR_materials_pbrSpecularGlossiness", ExtensionEffect::Drawn},
    {"KHR_materials_scatter", ExtensionEffect::Drawn},
    {"KHR_materials_sheen", ExtensionEffect::Drawn},
    {"KHR_materials_specular", ExtensionEffect::Drawn},
    {"KHR_materials_sss", ExtensionEffect::Drawn},
    {"KHR_materials_subsurface", ExtensionEffect::Drawn},
    {"KHR_materials_transmission", ExtensionEffect::Drawn},
    {"KHR_materials_unlit", ExtensionEffect::Drawn},
    {"KHR_materials_variants", ExtensionEffect::Drawn},
    {"KHR_materials_volume", ExtensionEffect::Drawn},
    {"KHR_materials_volume_scatter", ExtensionEffect::Drawn},
    {"KHR_mesh_quantization", ExtensionEffect::Drawn},
    {"KHR_meshopt_compression", ExtensionEffect::Drawn},
    {"KHR_node_visibility", ExtensionEffect::Drawn},
    {"KHR_texture_basisu", ExtensionEffect::Drawn},
    {"KHR_texture_transform", ExtensionEffect::Drawn},
    {"MSFT_texture_dds", ExtensionEffect::Looks},  // the same
    {"*_materials_", ExtensionEffect::Looks},
    {"*_lights_", ExtensionEffect::Looks},
    {"*_environment", ExtensionEffect::Looks},
    {"*_techniques_", ExtensionEffect::Looks},
    {"*_animation", ExtensionEffect::None},
    {"*_audio", ExtensionEffect::None},
    {"*_features", ExtensionEffect::None},
    {"*_hoverability", ExtensionEffect::None},
    {"*_interactivity", ExtensionEffect::None},
    {"*_metadata", ExtensionEffect::None},
    {"*_packing_", ExtensionEffect::None},  // packed textures come beside the core's own
    {"*_physics", ExtensionEffect::None},
    {"*_selectability", ExtensionEffect::None},
    {"*_xmp", ExtensionEffect::None},
    {"*MSFT_lod", ExtensionEffect::None},  // the most detailed level is the core's own
    {"*VRM", ExtensionEffect::None},
    {"*", ExtensionEffect::Content},
};

bool fits(const Extension& row, std::string_view name)
{
    return row.name.starts_with('*') ? name.find(row.name.substr(1)) != std::string_view::npos : name == row.name;
}

}  // namespace

ExtensionEffect getEffect(const std::string& name)
{
    return std::ranges::find_if(kExtensions, [&name](const Extension& row) { return fits(row, name); })->effect;
}

bool isMissing(const std::string& name)
{
    const ExtensionEffect effect = getEffect(name);
    return effect == ExtensionEffect::Looks || effect == ExtensionEffect::Content;
}

}  // namespace glim
