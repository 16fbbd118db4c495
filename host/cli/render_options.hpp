// What `glim render` is told.
#pragma once

#include "host/cli/error_report.hpp"
#include "host/cli/parse.hpp"
#include "host/cli/picture_options.hpp"

namespace glim {

enum class ProgressStyle { Auto, Bar, Json, None };

struct RenderOptions : PictureOptions {
    std::filesystem::path output;
    std::optional<std::filesystem::path> png, rates, stats;
    std::optional<SamplePlace> replay;  // instead of a picture
    ProgressStyle progress = ProgressStyle::Auto;
    ErrorTarget target;
};

// --progress, into `style`.
void addProgress(CLI::App& command, ProgressStyle& style);

// Adds every option of `render` to `command`; they write into `options`, which must outlive it.
void addRenderOptions(CLI::App& command, RenderOptions& options);

}  // namespace glim
