// Applies edits to a file that has been read.
#pragma once

#include "host/scene/edit.hpp"
#include "host/scene/gltf/gltf_file.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace glim {

// Makes the file what it would be with these edits, one after the other, in place of those before. Buffers stay as they were read. An edit
// sets a number, an array of numbers, a boolean or an enumerated string of a node, a material, a camera or a light, the weights of a mesh,
// or the uri of an image. Missing objects on the way are created. If an edit sets the translation, rotation or scale of a node with a
// matrix, the matrix is first split into the three. An edit of the matrix removes them. Returns the images whose uri is another than
// before. Throws InputError, and leaves the file as it was.
std::vector<std::size_t> editGltf(GltfFile& file, std::span<const Edit> edits);

}  // namespace glim
