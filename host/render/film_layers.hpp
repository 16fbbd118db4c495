// What is known of a film's pixels as layers of an image.
#pragma once

#include "host/image/image.hpp"
#include "host/render/film.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glim {

// A run of pixels.
struct Run {
    std::size_t begin, count;

    template <class Value>
    std::span<const Value> of(const std::vector<Value>& picture) const
    {
        return std::span(picture).subspan(begin, count);
    }
};

// Adds the film's pixels of the run, each as shown with its error if `errors`, and what else is known of them.
void addFilm(const Film& film, const Run& run, bool errors, Image& image);
// The pixels as addFilm has put them there. Refuses an image that lacks a channel (InputError, which uses `path`).
void takeFilm(const std::filesystem::path& path, const Image& image, bool hasSplats, Film& film);

// Adds moments in layers whose names begin with `prefix`. lightGroups: the names of the film's.
void addMoments(const FilmMoments& moments, const std::vector<std::string>& lightGroups, const Run& run, Image& image,
                const std::string& prefix);
// As addMoments has put them there. Leaves as it is what the image does not have.
void takeMoments(const std::filesystem::path& path, const Image& image, const std::vector<std::string>& lightGroups, FilmMoments& moments,
                 const std::string& prefix);

// A channel of whole numbers, one for each of `pixels`.
void takeCounts(const std::filesystem::path& path, const Image& image, const std::string& channel, std::vector<std::uint32_t>& pixels);

}  // namespace glim
