// Formats of scenes that glim does not read.
#pragma once

#include <filesystem>
#include <string_view>

namespace glim {

struct OtherFormat {
    std::string_view name;
    std::string_view start;    // its first bytes; empty where it has none of its own
    std::string_view endings;  // of file names
    std::string_view remedy;   // how to come to a file that glim reads
};

// By its first bytes before its ending, and by both before either. Null: unknown.
const OtherFormat* findOtherFormat(const std::filesystem::path& file, std::string_view start);

}  // namespace glim
