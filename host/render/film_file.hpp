// A film as an EXR file from which every bit of it can be read back.
//
// R, G, B      mean radiance, linear Rec.709; A coverage, with which R, G, B are already multiplied
// variance.RGB variance of R, G, B as means of independent blocks; infinity where a pixel has fewer than two blocks, and
//              no such layer if that is so everywhere. For other programs: reading a film ignores it
// albedo.RGB, normal.XYZ, depth.Z   as in PixelMoments; depth is infinity where every sample missed
// count.X, blocks.X, squares.RGB, clamped.X   the rest of PixelMoments, which merging needs
//
// If the render has light paths, R, G, B and variance are those of camera and light paths together, and there are more layers for merging:
// camera.RGB   PixelMoments::mean
// splats.RGB, splatSquares.RGB, splatClamped.X, splatCount.X, splatBlocks.X   SplatMoments
//
// A checkpoint is such a film and has more layers: page.* and folded.*, the finished blocks of the last page and the pages before it; with
// --adaptive neighbours common.*, chosen.X and blocksLeft.X; with --denoise firstHalf.* and secondHalf.* (checkpoint.hpp). The attribute
// glim:progress says where the render is. glim:guide has what is known of the picture's guide, or "none" if --guiding auto has found that
// it would not pay; glim:guideTexels has its texels, in a type of its own, "glim", which other programs pass over. Its digest is in
// glim:settings (guide=). Earlier builds pass both over and learn anew.
//
// denoised.RGB, denoisedError.RGB   a denoised picture and its estimated RMSE, for viewing: reading a film ignores them
//
// glim:digest, glim:headerDigest and glim:pixels serve to notice damage and to compare films (film.hpp).
//
// Layers end in one letter, as Blender expects; the attributes are named glim:*.
#pragma once

#include "host/image/image.hpp"
#include "host/render/checkpoint.hpp"

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace glim {

struct DenoisedLayers {
    std::span<const glm::vec3> radiance, error;
    std::string denoiser;
};

// What a file may have besides the film.
struct FilmAdditions {
    const Checkpoint* checkpoint = nullptr;
    const DenoisedLayers* denoised = nullptr;
};

// Returns the digests, which the file has.
FilmDigests writeFilm(const std::filesystem::path& path, const Film& film, const FilmAdditions& additions = {});
// The denoised radiance that a film's file has besides, if it has.
std::optional<std::vector<glm::vec3>> readDenoised(const std::filesystem::path& path);

// A film and what a later render needs to go on from its finished blocks. Returns nothing if `shouldContinue`, asked now and then, ended
// it; the file is then as it was.
std::optional<FilmDigests> writeFilm(
    const std::filesystem::path& path, const Film& film, const Checkpoint& checkpoint,
    const std::function<bool()>& shouldContinue = [] { return true; });

// Refuses (InputError) files that writeFilm did not write.
Film readFilm(const std::filesystem::path& path);
Film readFilm(const std::filesystem::path& path, const Image& image);  // that was read from there

// What a file holds.
struct StoredFilm {
    Film film;
    std::optional<Checkpoint> checkpoint;  // if it was written with one
};

// Refuses (InputError) what readFilm refuses, and damaged checkpoints.
StoredFilm readStoredFilm(const std::filesystem::path& path);

// The guide of its checkpoint, if it says something of one; without reading pixels. Refuses (InputError) a damaged one.
std::optional<LearnedGuide> readGuide(const std::filesystem::path& path);

// All but `pixels`.
Film readFilmHeader(const std::filesystem::path& path);
// The same of a picture that was read, which another program may have changed since: for what it says of itself, not for its pixels.
Film readFilmHeader(const std::filesystem::path& path, const Image& image);

// "0:256 512:768"
std::string sampleRangesText(const Film& film);

}  // namespace glim
