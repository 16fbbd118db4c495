// Cameras for tests.
#pragma once

#include "host/scene/scene.hpp"
#include "tests/harness/random.hpp"

namespace glim {

// Up to 1e3 m from the origin, looking anywhere.
inline Camera anyCamera(Random& random)
{
    Camera camera;
    const glm::dvec3 forward = random.direction();
    const glm::dvec3 right = glm::normalize(glm::cross(forward, random.direction()));
    camera.position = random.logUniform(1e-3, 1e3) * random.direction();
    camera.forward = forward;
    camera.right = right;
    camera.up = glm::cross(right, forward);
    return camera;
}

}  // namespace glim
