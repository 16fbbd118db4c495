// Reads how a file's nodes and cameras move while the shutter is open.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/load_gltf.hpp"
#include "host/scene/warnings.hpp"

namespace glim {

// Gives instances and cameras of `scene`, which is the file's at `seconds` into the animation, their motion. Warns of what moves and stays
// as it is at that time: lamps, what skins and morph targets bend, spheres, points and lines.
void readMotion(GltfFile& file, const LoadOptions& options, std::size_t animation, double seconds, Scene& scene, Warnings& warnings);

}  // namespace glim
