// What the file calls the things that rays meet.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/scene/scene.hpp"

#include <optional>
#include <string>

namespace glim {

struct PrimitiveDescription {
    std::string object;  // as in: mesh "floor", or: sphere without a name
    std::optional<std::uint32_t> triangle;  // of the mesh
    std::string material;
};

// "mesh "floor", triangle 3"
std::string textOf(const PrimitiveDescription& primitive);

PrimitiveDescription describePrimitive(const Scene& scene, std::uint32_t id);
PrimitiveDescription describeRecord(const Scene& scene, const FlatScene& flat, std::uint32_t record);

// As in: spot light "lamp", or: environment.
std::string describeLight(const Scene& scene, const FlatScene& flat, std::uint32_t light);

}  // namespace glim
