// What is behind a pixel.
#pragma once

#include "host/render/describe_primitive.hpp"
#include "host/render/prepare_scene.hpp"
#include "host/render/renderer.hpp"

#include <optional>

namespace glim {

struct Pick {
    glm::dvec3 position;     // world coordinates
    double distance;         // metres from where the ray begins
    PrimitiveDescription primitive;
};

// Of the ray through the centre of a pixel of a picture of this size, and the middle of a lens.
std::optional<Pick> pick(Renderer& renderer, const PreparedScene& prepared, const FlatCamera& camera, const glm::uvec2& pixel,
                         const glm::uvec2& size);

}  // namespace glim
