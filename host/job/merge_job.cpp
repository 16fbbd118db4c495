#include "host/job/merge_job.hpp"

#include "host/job/film_report.hpp"
#include "host/job/output_file.hpp"
#include "host/job/output_lock.hpp"
#include "host/job/parse.hpp"
#include "host/json.hpp"
#include "host/render/film_file.hpp"

#include <optional>

namespace glim {

void addMergeOptions(OptionTable& table, MergeJob& job)
{
    table.beginGroup("Picture");
    table.addPaths("films", "A.exr", "Films written by glim render or glim merge, in any order", job.inputs).require();
    table.beginGroup("Output");
    table.addPath("-o,--output", "C.exr", "Merged film, which may replace an input; or a picture", job.output).require();
    table.addEach("--light", "NAME=FACTOR", "What a light group is multiplied by, a number or R,G,B [1]; repeatable",
                  [&job](const OptionValue& value) { job.lights.push_back(parseLightWeight(value)); });
    addPictureFiles(table, job.pictures);
    addLook(table, job.look, "the picture", "none");
    table.onFinished([&table, &job] {
        resolveOutput(job.output, job.pictures);
        resolvePictureFiles(table, job.pictures);
    });
}

MergedFilm carryOut(const MergeJob& job)
{
    checkPictureTargets(job.pictures, {});
    std::optional<OutputLock> lock;
    if (job.output) {
        checkTarget(*job.output, ".exr", {});
        lock.emplace(*job.output);
    }
    MergedFilm merged = mergeFilms(job.inputs);
    if (!job.lights.empty()) {
        merged.film = regroup(merged.film, factorsOf(job.inputs.front(), merged.film, job.lights));
    }
    if (job.output) {
        writeFilm(*job.output, merged.film);
    }
    if (!job.pictures.empty()) {
        writePictures(job.pictures, merged.film, chooseLook(job.look, merged.film));
    }
    return merged;
}

Json describe(const MergedFilm& merged)
{
    const bool isKnown = pixelsWithoutError(merged.film) == 0;
    return {{"samples", sampleRangesText(merged.film)},
            {"exact", merged.exact},
            {"complete", merged.film.complete},
            {"estimate", isKnown ? describeEstimate(findError(merged.film, RenderSettings())) : Json()}};
}

}  // namespace glim
