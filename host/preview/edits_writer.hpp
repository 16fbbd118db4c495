// Saves what is shown for --edits.
#pragma once

#include "host/job/shown_options.hpp"

#include <filesystem>
#include <string>

namespace glim {

// Writes SCENE-001.edits.json in the working folder, where relative names of the options begin, or the next free number. Returns a sentence
// that says whether it was written.
std::string writeEdits(const std::filesystem::path& scene, const std::vector<ShownOption>& options);

}  // namespace glim
