#include "host/cli/commands.hpp"
#include "host/job/merge_job.hpp"
#include "host/message.hpp"
#include "host/render/film_file.hpp"

#include <iostream>
#include <memory>

namespace glim {

void addMerge(CommandLine& line)
{
    auto job = std::make_shared<MergeJob>();
    Command& command = line.addCommand("merge", "Merge renders of one picture over different samples or rows into one");
    addMergeOptions(command, *job);
    command.setFooter(
        "The films must agree in scene, camera, size, seed and settings, and their samples (render --samples) must\n"
        "not overlap. Adjacent ranges of 256 samples, starting at a multiple of 256, give the bits of a single run;\n"
        "other ranges give it up to rounding, and the command says so. Films of some rows (render --rows) must adjoin\n"
        "and have the same samples. A single film will do, to change its lights by --light.");
    command.onRun([job] {
        const MergedFilm merged = carryOut(*job);
        std::cerr << "Merged " << job->inputs.size() << " films into " << escaped(job->mainFile().string()) << ", samples "
                  << sampleRangesText(merged.film) << ": "
                  << (merged.exact           ? "bit-identical to a single run."
                      : merged.film.complete ? "equal to a single run up to rounding."
                                             : "some are missing, since a render was stopped early (see the layer count.X).")
                  << (job->lights.empty() ? "" : " Its lights are changed.") << '\n';
        return ExitCode::Done;
    });
}

}  // namespace glim
