// The outer layers of a glTF file: bytes, the binary container, JSON text.
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

// Splits a .glb (glTF 2.0, section 4) into its chunks; anything without its magic is taken for JSON, unless the name
// says .glb.
GltfContainer openContainer(const std::string& path, std::vector<unsigned char> bytes);

// Refuses what is nested too deeply before a recursive parser can see it.
nlohmann::json parseJson(const std::string& path, const std::string& text);

}  // namespace glim
