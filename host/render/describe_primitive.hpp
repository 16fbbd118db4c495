// Describes the primitive that a ray has hit, by the names in the scene's file.
#pragma once

#include "host/render/prepare_scene.hpp"

#include <optional>
#include <string>

namespace glim {

struct PrimitiveDescription {
    std::string object;                     // as in: instance "floor", or: sphere without a name
    std::optional<std::uint32_t> triangle;  // of its mesh; those of zero area do not count
    std::optional<std::uint32_t> point;     // of its cloud; or its line
    std::string material;
    std::uint32_t node, materialIndex;  // of the scene
    bool isLine = false;                // and no point
};

// What a ray has met: a triangle, a point or a line of one of the scene's instances, or, behind these, of one of its spheres.
struct ScenePart {
    std::uint32_t object = kNoIndex;  // nothing
    std::uint32_t triangle = 0;       // of the object, as in Primitives: those that nothing can meet do not count
    std::uint32_t point = kNoIndex;   // or line
};

ScenePart findPart(const PreparedScene& prepared, std::uint32_t ref);

// As in: instance "floor", triangle 3.
std::string toText(const PrimitiveDescription& primitive);

// Whether the primitive reference is one of the instances' (scene_types.h), and which of the primitives' placements it then belongs to.
bool isInstanced(const FlatScene& flat, std::uint32_t ref);
std::uint32_t findPlacement(const FlatScene& flat, std::uint32_t ref);

PrimitiveDescription describePrimitive(const PreparedScene& prepared, std::uint32_t ref);

// As in: spot light "lamp", or: environment.
std::string describeLight(const PreparedScene& prepared, std::uint32_t light);

}  // namespace glim
