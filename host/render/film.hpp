// A picture with its variance, its AOVs and its identity.
#pragma once

#include "host/scene/projection.hpp"
#include "shaders/shared/pixel_moments.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glim {

// Four questions, by what the file of a film has (film_file.hpp):
//   May two films be merged?                        glim:scene, glim:settings and glim:seed are equal, and no sample is in both
//   Would a single run have the bits of the merged? glim:kernels and glim:arithmetic are equal as well
//   Have two films the same pixels?                 glim:pixels is equal, whatever rendered them
//   Is a film whole, or are two the same one?       glim:digest, of all of the above, and glim:headerDigest, of the file's header
// Scene, kernels and arithmetic are fingerprints (host/fingerprint.hpp), the others SHA-256 (host/digest.hpp).
struct FilmIdentity {
    std::string scene;     // what was rendered: geometry, materials, lights, camera
    std::string settings;  // every option that changes a sample: "sampler=sobol bounces=64 ..."
    std::uint32_t seed = 0;
    std::string kernels;
};

// What light paths have brought to a pixel: caustics, which camera paths leave out. Samples are those of the picture, the same for all
// pixels.
struct SplatMoments {
    std::uint32_t count = 0, blocks = 0;
    glm::vec3 mean{0.0F}, squares{0.0F};  // as in PixelMoments
    float clamped = 0.0F;
};

// What is known of pixels by light groups: momentsOfGroups() for each (shaders/shared/pixel_moments.h). Counts are those of PixelMoments or
// SplatMoments.
struct GroupMoments {
    std::uint32_t groups = 0;
    std::vector<glm::vec3> values;

    GroupMoments() = default;
    GroupMoments(std::uint32_t groupCount, std::size_t pixels)
        : groups(groupCount),
          values(pixels * momentsOfGroups(groupCount))
    {}
    bool isEmpty() const { return values.empty(); }
    std::size_t pixelCount() const { return isEmpty() ? 0 : values.size() / momentsOfGroups(groups); }
    std::span<glm::vec3> of(std::size_t pixel)
    {
        return std::span(values).subspan(pixel * momentsOfGroups(groups), momentsOfGroups(groups));
    }
    std::span<const glm::vec3> of(std::size_t pixel) const
    {
        return std::span(values).subspan(pixel * momentsOfGroups(groups), momentsOfGroups(groups));
    }
};

// Row 0 at the top, left to right.
struct FilmMoments {
    std::vector<PixelMoments> pixels;     // of camera paths
    std::vector<SplatMoments> splats;     // of light paths; empty if there were none
    std::vector<CatcherMoments> catcher;  // of shadow catchers; empty if there were none
    GroupMoments groups, splatGroups;     // of both kinds of paths, by light groups; empty if there were none
};

// All else that is known of a film.
struct FilmHeader {
    std::uint32_t width = 0, height = 0;
    std::uint32_t rowsAbove = 0, rowsBelow = 0;                         // of the picture, or of its crop, which the film lacks
    std::optional<Crop> crop;                                           // of the picture
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sampleRanges;  // [begin, end), ascending, disjoint
    bool complete = true;                                               // each pixel has all of sampleRanges or, if adaptive, its own share
    FilmIdentity identity;
    double seconds = 0.0;         // spent sampling
    std::string device;           // names the device and driver
    std::string arithmetic;       // fingerprints of how all devices round, with spaces between them
    std::string sceneFile;        // as given
    std::string camera;           // as describeFilmCamera() says; empty of films of earlier builds
    bool showsBackground = true;  // false: pictures are transparent where no surface is
};

struct Film : FilmHeader, FilmMoments {};

// Of what makes the film: its identity, sample ranges and moments, not when and where it was rendered.
std::string computeDigest(const Film& film);

// Of the moments alone.
std::string computePixelsDigest(const Film& film);

// Both. They take a while.
struct FilmDigests {
    std::string film, pixels;
};
inline FilmDigests computeDigests(const Film& film) { return {computeDigest(film), computePixelsDigest(film)}; }

// Splats are moments without what only camera rays know.
PixelMoments widened(const SplatMoments& splat);
SplatMoments narrowed(const PixelMoments& pixel);
SplatMoments foldMoments(const SplatMoments& a, const SplatMoments& b);

// Folds `page`, which has the same pixels or none, onto `film`.
void foldMoments(FilmMoments& film, const FilmMoments& page);
void foldSplats(FilmMoments& film, const FilmMoments& page);  // light paths alone; either may have none

// Those of a pixel by groups onto others, of which it has so many samples.
void foldGroups(std::span<glm::vec3> film, std::uint32_t filmSamples, std::span<const glm::vec3> page, std::uint32_t pageSamples,
                std::uint32_t groups);

// Names of the light groups, in the order of GroupMoments.
std::vector<std::string> getLightGroups(const Film& film);

// Whether all of it is of one arithmetic: only then can it be bit-identical to a single run.
bool hasOneArithmetic(const Film& film);
void addArithmetic(Film& film, const std::string& arithmetic);

// A page of some pixels, by camera paths.
struct PageView {
    std::span<const PixelMoments> pixels;
    std::span<const CatcherMoments> catcher;  // empty without catchers
    std::span<const glm::vec3> groups;        // as GroupMoments::values
};

// Folds `page` onto the pixels of `film` from index `begin` on.
void foldPage(FilmMoments& film, std::size_t begin, const PageView& page);

// Variance of a pixel's mean from its block means; NaN where fewer than two blocks are known.
glm::vec3 computeVarianceOfMean(const PixelMoments& moments);

// The pixel as the film shows it: its moments with the mean, the variance of the mean and the clamped light of camera and light paths
// together.
PixelMoments shownPixel(const Film& film, std::size_t i);
std::vector<PixelMoments> shownPixels(const Film& film);

// The light of a group that it shows there.
glm::vec3 shownOfGroup(const Film& film, std::size_t pixel, std::size_t group);
// The covariance of the shown light of two groups; NaN where fewer than two blocks are known.
glm::vec3 computeGroupCovariance(const Film& film, std::size_t pixel, std::size_t group, std::size_t other);

}  // namespace glim
