// Opens the outer layers of a glTF file: bytes, binary container, JSON text.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace glim {

struct GltfContainer {
    // Where the BIN chunk of a .glb is.
    struct Chunk {
        std::uint64_t begin = 0, size = 0;
    };
    std::string json;
    std::optional<Chunk> binary;
};

// At most `most` bytes, from `begin` on. Throws InputError: "<file>: cannot be read: <reason>".
std::vector<unsigned char> readBytes(const std::filesystem::path& file, std::uint64_t most = std::numeric_limits<std::uint64_t>::max(),
                                     std::uint64_t begin = 0);

// Reads a .glb (glTF 2.0, section 4) chunk by chunk, without the content of its BIN chunk. A file that does not begin with its magic number is taken for JSON, unless its name
// ends in .glb or it begins as no JSON does.
GltfContainer openContainer(const std::filesystem::path& file);

// Refuses JSON that is nested too deeply, before a recursive parser sees it.
nlohmann::json parseJson(const std::string& path, const std::string& text);

}  // namespace glim
