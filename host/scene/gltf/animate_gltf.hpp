// Sets the properties of a file to the values that an animation gives them at one time.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/warnings.hpp"

namespace glim {

// From the first to the last second of an animation: the last one of its keyframes.
double computeDuration(const GltfFile& file, std::size_t animation);

// Replaces the file's model by the rest pose with the animation's values at `seconds`. Core channels and those of KHR_animation_pointer are
// one: a channel sets what its pointer points to. Values outside the range of their property are clamped, as those of splines may be.
void animateGltf(GltfFile& file, std::size_t animation, double seconds, Warnings& warnings);

// Undoes animateGltf.
void restoreRestPose(GltfFile& file);

}  // namespace glim
