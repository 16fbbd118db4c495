// Opens the outer layers of a glTF file: bytes, binary container, JSON text.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glim {

struct GltfContainer {
    std::string json;
    std::optional<std::vector<unsigned char>> binary;  // the BIN chunk of a .glb
};

// Throws InputError: "<file>: cannot be read: <reason>".
std::vector<unsigned char> readBytes(const std::filesystem::path& file);

// Splits a .glb (glTF 2.0, section 4) into its chunks. A file that does not begin with its magic number is taken for JSON, unless its name
// ends in .glb.
GltfContainer openContainer(const std::string& path, std::vector<unsigned char> bytes);

// Refuses JSON that is nested too deeply, before a recursive parser sees it.
nlohmann::json parseJson(const std::string& path, const std::string& text);

}  // namespace glim
