// A glTF file whose JSON has been checked and whose buffers are in memory: what every reader in this folder starts
// from.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <string>
#include <vector>

namespace glim {

struct GltfFile {
    std::string path;  // as given, for messages
    std::vector<std::filesystem::path> files;  // that were read: this one and those of its buffers
    // Index properties are in range, numbers have their type. Holds no buffers, images, skins or animations.
    tinygltf::Model model;
    std::vector<std::vector<unsigned char>> buffers;  // each at least as long as its byteLength
    bool animated = false;
};

GltfFile readGltfFile(const std::filesystem::path& file);

// Throws InputError: "<path>: <sentence>".
[[noreturn]] void refuse(const GltfFile& file, const std::string& sentence);

// How messages name things: nodes[3] ("lamp").
std::string label(const char* collection, std::size_t index, const std::string& name);
std::string nodeLabel(const GltfFile& file, std::size_t node);

std::string toText(double value);  // shortest of six significant digits

}  // namespace glim
