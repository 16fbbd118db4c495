#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <optional>
#include <string>

namespace glim {

// Refuses (InputError) an OpenEXR file with an attribute that is longer than the file or does not fit its type, and limits the size of
// pictures. To be called before OpenEXR opens a file: it allocates what a header promises before it reads on.
void checkExrHeader(const std::filesystem::path& path);

// A text attribute of a header of one part, and SHA-256 over the bytes of the header, in which this text is all zeros.
struct HeaderSeal {
    std::uint64_t position = 0;  // of the text in the file
    std::string text, digest;
};

// `stream` has the bytes of a file, or enough of its beginning. Nothing if its header lacks the attribute.
std::optional<HeaderSeal> findSeal(std::istream& stream, const std::string& attribute);

}  // namespace glim
