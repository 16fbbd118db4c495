// The options of `glim render`.
#pragma once

#include "host/cli/checkpoint_writer.hpp"
#include "host/cli/film_report.hpp"
#include "host/cli/parse.hpp"
#include "host/cli/picture_options.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/sequence.hpp"

namespace glim {

struct RenderOptions : PictureOptions {
    std::filesystem::path output;
    PictureFiles pictures;
    std::optional<std::filesystem::path> rates, ids, stats;
    SequenceOptions sequence;
    bool denoise = false;
    std::optional<std::filesystem::path> oidn;  // instead of glim's own denoiser
    CheckpointOptions checkpoint;
    std::optional<SamplePlace> replay;  // instead of a picture
    ProgressStyle progress = ProgressStyle::Auto;
    ErrorTarget target;
};

// Adds every option of `render` to `command`; they write into `options`, which must outlive it.
void addRenderOptions(const Command& command, RenderOptions& options);

}  // namespace glim
