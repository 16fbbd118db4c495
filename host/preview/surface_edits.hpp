// What the window changes of the surface that was clicked.
#pragma once

#include "host/render/describe_primitive.hpp"
#include "host/scene/load_gltf.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace glim {

// A number of a material that a slider changes.
struct MaterialFactor {
    const char *name, *pointer;  // below the material's
    float Material::*value;
    float least, most;
};

// Those that most materials differ by come first.
inline constexpr std::array<MaterialFactor, 9> kMaterialFactors{{
    {"metallic", "/pbrMetallicRoughness/metallicFactor", &Material::metallic, 0.0F, 1.0F},
    {"roughness", "/pbrMetallicRoughness/roughnessFactor", &Material::roughness, 0.0F, 1.0F},
    {"transmission", "/extensions/KHR_materials_transmission/transmissionFactor", &Material::transmission, 0.0F, 1.0F},
    {"IOR", "/extensions/KHR_materials_ior/ior", &Material::ior, 1.0F, 2.5F},
    {"specular", "/extensions/KHR_materials_specular/specularFactor", &Material::specular, 0.0F, 1.0F},
    {"coat", "/extensions/KHR_materials_clearcoat/clearcoatFactor", &Material::clearcoat, 0.0F, 1.0F},
    {"coat roughness", "/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", &Material::clearcoatRoughness, 0.0F, 1.0F},
    {"iridescence", "/extensions/KHR_materials_iridescence/iridescenceFactor", &Material::iridescence, 0.0F, 1.0F},
    {"anisotropy", "/extensions/KHR_materials_anisotropy/anisotropyStrength", &Material::anisotropy, 0.0F, 1.0F},
}};
inline constexpr std::size_t kUsualFactors = 2;  // which always show

// What the panel shows of a surface, and the user changes there.
struct SurfaceChoices {
    glm::vec4 baseColor{1.0F};  // linear, with alpha
    std::array<float, kMaterialFactors.size()> factors{};
    glm::vec3 emission{0.0F};       // linear, at most 1
    float emissionStrength = 1.0F;  // multiplies it
    bool hasStrength = false;       // the material has KHR_materials_emissive_strength; the user does not change it here
    glm::vec3 translation{0.0F};    // of its node
    bool hides = false, isolates = false, showsAll = false;  // buttons

    bool operator==(const SurfaceChoices&) const = default;
};

// The surface that was clicked, and where edits find it; nothing for what no file has.
struct ChosenSurface {
    std::string name;
    std::uint32_t node, material;  // of the scene
    std::optional<std::string> nodePointer, materialPointer;
    SurfaceChoices choices;  // as the user wants them; the scene follows
};

ChosenSurface chooseSurface(const PrimitiveDescription& primitive, const Scene& scene, const SceneFile& file);

// As they are in the scene.
SurfaceChoices choicesOf(const ChosenSurface& surface, const Scene& scene, const SceneFile& file);

// The edits that make the one the other: of what differs, and of what can be changed.
std::vector<Edit> listEdits(const ChosenSurface& surface, const SurfaceChoices& before, const SurfaceChoices& after);

// The edit that hides the node at a pointer.
Edit hidingEdit(const std::string& nodePointer);
bool hides(const Edit& edit);

// `edits` with another one, in place of that of the same pointer.
std::vector<Edit> withEdit(std::vector<Edit> edits, const Edit& edit);

}  // namespace glim
