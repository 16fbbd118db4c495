// The options of `glim render`.
#pragma once

#include "host/job/checkpoint_writer.hpp"
#include "host/job/film_report.hpp"
#include "host/job/parse.hpp"
#include "host/job/picture_options.hpp"
#include "host/job/progress.hpp"
#include "host/job/sequence.hpp"

namespace glim {

struct RenderJob : PictureOptions {
    std::optional<std::filesystem::path> output;  // without one the film is not kept
    PictureFiles pictures;
    std::optional<std::filesystem::path> rates, layers, ids, surfaces, objects, stats;
    ExrCompression compression = ExrCompression::Zip;  // of the layers
    std::optional<double> flow;                        // seconds, of the surfaces
    std::optional<glm::uvec2> focus;                   // the pixel that says the lens's focal distance (focus.hpp)
    SequenceOptions sequence;
    std::optional<std::filesystem::path> movie;  // of the sequence's first picture files
    bool denoise = false, noDenoise = false;     // a picture of few samples that is written without its film is denoised unless noDenoise
    std::optional<std::filesystem::path> oidn;   // instead of glim's own denoiser
    CheckpointOptions checkpoint;
    std::optional<SamplePlace> replay;  // instead of a picture
    ProgressStyle progress = ProgressStyle::Auto;
    ErrorTarget target;

    // By which messages name the render, and which only one process may write: the film's, else the first picture's.
    const std::filesystem::path& mainFile() const { return output ? *output : pictures.front(); }
};

// Adds every option of `render` to `table`; they write into `options`, which must outlive it.
void addJobOptions(OptionTable& table, RenderJob& options);

}  // namespace glim
