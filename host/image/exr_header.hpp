#pragma once

#include <filesystem>

namespace glim {

// Refuses (InputError) an OpenEXR file with an attribute that is longer than the file or does not fit its type, and limits the size of
// pictures. To be called before OpenEXR opens a file: it allocates what a header promises before it reads on.
void checkExrHeader(const std::filesystem::path& path);

}  // namespace glim
