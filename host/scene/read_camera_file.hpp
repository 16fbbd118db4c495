// Cameras of a JSON file: an array of objects, each a camera of the scene's file in another pose.
//
//   {"camera": NAME or INDEX, "from": [x, y, z], "at": [x, y, z], "up": [x, y, z], "zoom": z}
//   {"camera": NAME or INDEX, "matrix": [16 numbers], "axes": "gltf" or "opencv", "yfov": radians}
//
// Every member may be left out; `from` and `at` go together. `matrix` takes the camera to the world, columns first, and `yfov` is the
// vertical field of view, both as in glTF. OpenCV's cameras look along +z, with +y down.
#pragma once

#include "host/scene/pose.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glim {

struct CameraEntry {
    std::optional<std::string> camera;  // of the scene's file: name or index
    std::optional<Pose> pose;
    std::optional<double> yfov;  // radians, in (0, pi)
};

// Returns at least one. Throws InputError with one sentence that names file, place, value and what was expected.
std::vector<CameraEntry> readCameraFile(const std::filesystem::path& file);

}  // namespace glim
