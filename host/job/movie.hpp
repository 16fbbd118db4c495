// --movie: the pictures of a sequence, one after the other.
#pragma once

#include "host/job/interrupt.hpp"
#include "host/job/render_job.hpp"

#include <filesystem>
#include <iosfwd>
#include <vector>

namespace glim {

// How many pictures a movie of the options shows a second: as many as pass in the animation, or --fps.
double movieRate(const SequenceOptions& sequence);

// Makes a movie of one black picture, and keeps nothing of it: what ffmpeg lacks is better known before a long render. Throws InputError.
void checkMovie(const RenderJob& options);

// Makes the movie of these files, which have one size. A side that is odd gets its last row or column twice, since the colours of 2x2
// pixels are one. What is transparent is over black. Throws InputError if a picture cannot be read or ffmpeg fails.
ExitCode makeMovie(const RenderJob& options, const std::vector<std::filesystem::path>& pictures, const InterruptWatch& watch,
                   std::ostream& reports);

}  // namespace glim
