// Files that commands read.
#pragma once

#include <filesystem>
#include <string>

namespace glim {

bool isUrl(const std::string& name);

// Throws InputError unless `file` is a regular file or a link to one: reading from a pipe could block forever, and a device may have no
// end. `expected` as in "an OpenEXR file".
void requireFile(const std::filesystem::path& file, const std::string& expected);

}  // namespace glim
