// Whether an output can be written, asked before any work.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace glim {

// Refuses (InputError) what checkWritable refuses, a folder in which no file can be made after all, and a target that is one
// of `inputs`. Leaves no trace.
void checkTarget(const std::filesystem::path& target, std::string_view extension,
                 const std::vector<std::filesystem::path>& inputs);

}  // namespace glim
