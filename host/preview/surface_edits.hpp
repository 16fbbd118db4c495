// What the window changes of the surface that was clicked.
#pragma once

#include "host/render/describe_primitive.hpp"
#include "host/scene/load_gltf.hpp"

#include <optional>
#include <string>
#include <vector>

namespace glim {

// What the panel shows of a surface, and the user changes there.
struct SurfaceChoices {
    glm::vec4 baseColor{1.0F};  // linear; alpha stays
    float metallic = 1.0F, roughness = 1.0F;
    glm::vec3 translation{0.0F};  // of its node

    bool operator==(const SurfaceChoices&) const = default;
};

// The surface that was clicked, and where edits find it; nothing for what no file has.
struct ChosenSurface {
    std::string name;
    std::uint32_t node, material;  // of the scene
    std::optional<std::string> nodePointer, materialPointer;
};

ChosenSurface chooseSurface(const PrimitiveDescription& primitive, const Scene& scene, const SceneFile& file);

SurfaceChoices choicesOf(const ChosenSurface& surface, const Scene& scene, const SceneFile& file);

// The edits that make the one the other: of what differs, and of what can be changed.
std::vector<Edit> listEdits(const ChosenSurface& surface, const SurfaceChoices& before, const SurfaceChoices& after);

// `edits` with another one, in place of that of the same pointer.
std::vector<Edit> withEdit(std::vector<Edit> edits, const Edit& edit);

// Those of the options, then the user's.
std::vector<Edit> joinEdits(std::vector<Edit> first, const std::vector<Edit>& then);

// As options of `glim render`: " --set /materials/0/alphaCutoff=0.5 ...".
std::string editOptions(const std::vector<Edit>& edits);

}  // namespace glim
