// Files that commands write.
#pragma once

#include "host/json.hpp"

#include <filesystem>
#include <string_view>
#include <vector>

namespace glim {

// To be called before any work. Refuses a name that does not end in `extension` (UsageError; ".exr" in any case; empty allows all), and
// (InputError) what checkWritable refuses, a folder in which no file can be made after
// all, and a target that is one of `inputs`. Leaves no trace.
void checkTarget(const std::filesystem::path& target, std::string_view extension, const std::vector<std::filesystem::path>& inputs);

// Write the whole file or, with InputError, nothing.
void writeText(const std::filesystem::path& path, std::string_view text);
void writeJson(const std::filesystem::path& path, const Json& json);

}  // namespace glim
