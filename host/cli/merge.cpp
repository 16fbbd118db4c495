#include "host/cli/commands.hpp"
#include "host/job/look_options.hpp"
#include "host/job/output_file.hpp"
#include "host/job/output_lock.hpp"
#include "host/message.hpp"
#include "host/render/film_file.hpp"
#include "host/render/merge_films.hpp"

#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

namespace glim {
namespace {

struct MergeOptions {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path output;
    PictureFiles pictures;
    LookOptions look;
};

void runMerge(const MergeOptions& options)
{
    checkTarget(options.output, ".exr", {});
    checkPictureTargets(options.pictures, {});
    const OutputLock lock(options.output);
    const MergedFilm merged = mergeFilms(options.inputs);
    writeFilm(options.output, merged.film);
    if (!options.pictures.empty()) {
        writePictures(options.pictures, merged.film, chooseLook(options.look, merged.film));
    }
    std::cerr << "Merged " << options.inputs.size() << " films into " << escaped(options.output.string()) << ", samples "
              << sampleRangesText(merged.film) << ": "
              << (merged.exact           ? "bit-identical to a single run."
                  : merged.film.complete ? "equal to a single run up to rounding."
                                         : "some are missing, since a render was stopped early (see the layer count.X).")
              << '\n';
}

}  // namespace

void addMerge(CommandLine& line)
{
    auto options = std::make_shared<MergeOptions>();
    Command& command = line.addCommand("merge", "Merge renders of one picture over different samples or rows into one");
    command.beginGroup("Picture");
    command.addPaths("films", "A.exr", "Films written by glim render or glim merge, in any order", options->inputs).require();
    command.beginGroup("Output");
    command.addPath("-o,--output", "C.exr", "Merged film; it may replace one of the inputs", options->output).require();
    addPictureFiles(command, options->pictures);
    addLook(command, options->look, "the picture", "none");
    command.setFooter(
        "The films must agree in scene, camera, size, seed and settings, and their samples (render --samples) must\n"
        "not overlap. Adjacent ranges of 256 samples, starting at a multiple of 256, give the bits of a single run;\n"
        "other ranges give it up to rounding, and the command says so. Films of some rows (render --rows) must adjoin\n"
        "and have the same samples.");
    command.onFinished([&command, options] { resolvePictureFiles(command, options->pictures); });
    command.onRun([options] {
        runMerge(*options);
        return ExitCode::Done;
    });
}

}  // namespace glim
