// What `glim bench` is told.
#pragma once

#include "host/cli/render_options.hpp"

#include <vector>

namespace glim {

inline constexpr std::uint32_t kBenchHeight = 96;  // pixels, of the picture that nobody gave a size

struct BenchOptions : PictureOptions {
    std::vector<std::filesystem::path> scenes;
    bool kernels = false;  // how fast rays are traced instead
    std::filesystem::path output = "bench.json";  // .csv and references lie beside it
    bool outputGiven = false;
    std::optional<std::filesystem::path> reference, against;
    bool makeReference = false;
    double seconds = 1.0;  // of each seed
    std::optional<std::uint32_t> samples;
    std::uint32_t seeds = 16;
    ProgressStyle progress = ProgressStyle::Auto;
};

// Adds every option of `bench` to `command`; they write into `options`, which must outlive it.
void addBenchOptions(CLI::App& command, BenchOptions& options);

std::filesystem::path csvOf(const BenchOptions& options);
// Where the reference of `scene` lies unless --reference names another.
std::filesystem::path referenceOf(const BenchOptions& options, const std::filesystem::path& scene);

}  // namespace glim
