// Joins the scenes of several files into one.
#pragma once

#include "host/scene/scene.hpp"

#include <vector>

namespace glim {

struct AddedScene {
    Scene scene;
    glm::dmat4 worldFromScene;  // affine and invertible
};

// The meshes of a scene that was joined. The next one of the same parts has the same ones.
struct JoinedMeshes {
    std::vector<SharedVector<Mesh>> parts;
    std::vector<std::uint32_t> firstMaterials;  // of the scenes that are added
    SharedVector<Mesh> meshes;
};

// `scene` with the shapes, punctual lights and materials of the others, placed by their matrices. Environment, cameras, animations and
// variants are its own. Lights keep their intensity, whatever the scale. Throws InputError where a matrix makes a sphere something
// else or places something too far away, and if all images take more than kernels address.
Scene joinScenes(Scene scene, const std::vector<AddedScene>& others, JoinedMeshes& joined);

}  // namespace glim
