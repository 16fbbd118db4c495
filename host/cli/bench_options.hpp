// The options of `glim bench`.
#pragma once

#include "host/job/picture_options.hpp"
#include "host/job/progress.hpp"

#include <vector>

namespace glim {

inline constexpr std::uint32_t kBenchHeight = 96;  // pixels, without --size

struct BenchOptions : PictureOptions {
    std::vector<std::filesystem::path> scenes;
    bool kernels = false;                         // measure ray rates instead
    std::filesystem::path output = "bench.json";  // .csv and references lie beside it
    bool outputGiven = false;
    std::optional<std::filesystem::path> reference, against;
    bool makeReference = false;
    double seconds = 1.0;  // of each seed
    std::optional<std::uint32_t> samples;
    std::uint32_t seeds = 16;
    ProgressStyle progress = ProgressStyle::Auto;
    std::vector<std::string> words;  // SceneBench::options
};

// Adds every option of `bench` to `command`; they write into `options`, which must outlive it.
void addBenchOptions(OptionTable& table, BenchOptions& options);

std::filesystem::path getCsvPath(const BenchOptions& options);
// The file of the reference for `scene`, if --reference names none.
std::filesystem::path getReferencePath(const BenchOptions& options, const std::filesystem::path& scene);

}  // namespace glim
