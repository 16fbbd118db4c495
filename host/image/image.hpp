// The content of an EXR file: named planes of numbers, and attributes.
#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <variant>
#include <vector>

namespace glim {

// None of them loses anything.
enum class ExrCompression { Zip, Zips, Piz, Rle, None };

// Of no type that OpenEXR knows: other programs pass it over. (exrinfo -v prints 12 MB of a floatvector of 4 MB.)
using OpaqueBytes = std::vector<std::byte>;

struct Image {
    std::uint32_t width = 0, height = 0;
    std::uint32_t rowsAbove = 0, rowsBelow = 0;                // of the display window, which the image lacks
    std::uint32_t columnsLeft = 0, columnsRight = 0;           // the same
    std::map<std::string, std::vector<float>> channels;        // "R", "albedo.G" ...; row 0 at the top, left to right
    std::map<std::string, std::vector<std::uint32_t>> counts;  // channels of integers, which float32 might round
    std::map<std::string, std::variant<double, std::string, glm::mat4, OpaqueBytes>> attributes;  // matrices are written, but not read
    std::set<std::string> halves;                      // channels that are written as 16-bit floats
    ExrCompression compression = ExrCompression::Zip;  // of a file that is written
};

}  // namespace glim
