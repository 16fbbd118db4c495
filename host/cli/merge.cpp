#include "host/cli/merge.hpp"

#include "host/cli/check_target.hpp"
#include "host/cli/parse.hpp"
#include "host/render/film_file.hpp"
#include "host/render/film_pictures.hpp"
#include "host/render/merge_films.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

namespace glim {
namespace {

struct MergeOptions {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path output, png;
    double exposure = 0.0;
};

void runMerge(const MergeOptions& options)
{
    checkTarget(options.output, ".exr", {});
    if (!options.png.empty()) {
        checkTarget(options.png, ".png", {});
    }
    const MergedFilm merged = mergeFilms(options.inputs);
    writeFilm(options.output, merged.film);
    if (!options.png.empty()) {
        writeFilmPng(options.png, merged.film, lookOf(merged.film), options.exposure);
    }
    std::cerr << "Merged " << options.inputs.size() << " films into " << options.output.string() << ", samples "
              << sampleRangesText(merged.film) << ": "
              << (merged.exact           ? "the bits of the single run."
                  : merged.film.complete ? "equal to the single run up to rounding."
                                         : "some are missing, since a render was ended early (see the layer count.X).")
              << '\n';
}

}  // namespace

void addMerge(CLI::App& app)
{
    auto options = std::make_shared<MergeOptions>();
    CLI::App* command = app.add_subcommand("merge", "Merge renders of one scene over different samples into one");
    command->footer("The films must agree in scene, camera, size, seed and settings, and their samples must not overlap\n"
                    "(render --samples A:B). Films of one page, 256 samples from a multiple of 256 on, that continue each\n"
                    "other give the bits of the single run; other ranges give it up to rounding, and that is said.");
    command->add_option("films", options->inputs, "Films written by glim render or glim merge, in any order (.exr)")
        ->required()
        ->type_name("A.exr");
    command->add_option("-o,--output", options->output, "The merged film; it may replace one of the inputs (.exr)")
        ->required()
        ->type_name("C.exr");
    CLI::Option* png = command->add_option("--png", options->png, "Also write an sRGB picture to look at (.png)");
    png->type_name("C.png");
    addExposure(*command, options->exposure, "a PNG")->needs(png);
    command->callback([options] { runMerge(*options); });
}

}  // namespace glim
