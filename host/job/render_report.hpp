// The report of a render: one line for people, JSON for machines.
#pragma once

#include "host/job/denoising.hpp"
#include "host/job/film_report.hpp"
#include "host/job/render_job.hpp"
#include "host/measure/control_bias.hpp"
#include "host/render/learned_guide.hpp"
#include "host/render/prepare_scene.hpp"
#include "host/render/suspects.hpp"

#include <iosfwd>

namespace glim {

struct RenderReport {
    const RenderJob& options;
    const PreparedScene& prepared;
    const Film& film;
    FilmDigests digests;             // if statistics are asked for
    std::optional<FilmError> error;  // nothing if there was no memory to find it
    std::optional<Look> look;        // of the picture, if one was asked for
    const RenderStatistics& statistics;
    const DeviceDescription& device;
    std::string stopReason;  // "samples", "time", "tolerance", "target", "unknown error", or the signal's name
    double writeSeconds;
    std::optional<double> idSeconds;  // of --ids, --surfaces and --objects
    std::vector<Suspect> suspects;
    std::optional<ControlBias> bias;           // of adaptive renders
    std::optional<Denoising> denoising;        // of --denoise
    const std::optional<LearnedGuide>& guide;  // as in PictureFrame
    bool keepsGuide;                           // the same
};

// Of what is wrong or missing in a picture, as far as it is known.
void warnOfPicture(const Film& film, const RenderStatistics& statistics, const RenderSettings& settings);
void printSummary(const RenderReport& report, std::ostream& out);
void writeStatistics(const std::filesystem::path& path, const RenderReport& report);

}  // namespace glim
