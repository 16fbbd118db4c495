// Benches as JSON, with the raw figures and what follows from them, and as CSV with the raw figures alone.
#pragma once

#include "host/bench/bench_record.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace glim {

std::string benchJson(const std::vector<SceneBench>& benches);

// A line for every render of every point.
std::string benchCsv(const std::vector<SceneBench>& benches);

// The raw figures. Refuses (InputError) what benchJson did not write.
std::vector<SceneBench> readBenches(const std::filesystem::path& file);

}  // namespace glim
