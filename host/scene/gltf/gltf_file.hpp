// A glTF file with checked JSON and its buffers in memory. All readers in this folder begin with it.
#pragma once

#include "host/scene/scene.hpp"

#include <tiny_gltf.h>

#include <filesystem>
#include <string>
#include <vector>

namespace glim {

struct GltfFile {
    std::string path;                          // as given, for messages
    std::vector<std::filesystem::path> files;  // this one and those of its buffers
    // Index properties are in range, numbers have their type. Holds no buffers, images, skins or animations.
    tinygltf::Model model;
    std::vector<std::vector<unsigned char>> buffers;  // each at least as long as its byteLength
    std::vector<EncodedImage> images;
    bool animated = false;
};

GltfFile readGltfFile(const std::filesystem::path& file);

// Throws InputError: "<path>: <sentence>".
[[noreturn]] void refuse(const GltfFile& file, const std::string& sentence);

// How messages name things: nodes[3] ("lamp").
std::string label(const char* collection, std::size_t index, const std::string& name);
std::string nodeLabel(const GltfFile& file, std::size_t node);

std::string toText(double value);  // at most six significant digits

}  // namespace glim
