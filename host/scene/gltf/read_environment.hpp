// The light from all around a scene, and the sun: what the file has, or what the options choose.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/gltf/read_images.hpp"
#include "host/scene/load_gltf.hpp"
#include "host/scene/warnings.hpp"

#include <optional>

namespace glim {

// That of the options, else that of the file's scene (extras.environment or EXT_lights_image_based); nothing if there is none. Adds the
// files that it reads to those of the scene. Throws InputError.
std::optional<Environment> chooseEnvironment(const GltfFile& file, const LoadOptions& options, DecodedParts& decoded, Scene& scene,
                                             Warnings& warnings);

Environment makeStudioEnvironment(const LoadOptions& options, DecodedParts& decoded);

PunctualLight lightOf(const Sun& sun);

}  // namespace glim
