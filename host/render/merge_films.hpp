// Merges films of the same picture: folds them in order of their samples, and puts bands of rows together.
//
// A render is the left fold of its pages of kPageSamples. So a merge gives the bits of a single run if and only if the first film is one
// contiguous run, and each further film begins at the start of the next page and holds at most that page. Such ranges are joined ("0:512").
// Ranges that were merged only up to rounding stay apart ("0:512 512:1024"), so that a film never claims the bits of a run that it does not
// equal. A block that the ranges cut in two counts as two blocks.
//
// Films of a band of rows (--rows) are first folded band by band. Then the bands, which must be adjacent and have the same samples, become
// one film.
#pragma once

#include "host/message.hpp"
#include "host/render/film.hpp"

#include <filesystem>
#include <functional>
#include <optional>

namespace glim {

struct MergePlan {
    std::vector<std::size_t> order;  // indices of the films, by their first row, then by their first sample
    bool exact = true;
};

// Looks at the headers only. Refuses different pictures, overlapping samples and rows that do not fit (InputError, which uses `names`).
MergePlan planMerge(const std::vector<Film>& films, const std::vector<std::string>& names);

// In what `film` is of another picture or other rows than `first`, as in "its seed is 1, expected 0"; nothing if it is of the same.
std::optional<Message> findDifference(const Film& film, const Film& first);

// Whether both are of the same picture and have a sample in common.
bool shareSamples(const Film& a, const Film& b);

// Whether `next` continues `film` with the bits of a single run.
bool continuesExactly(const Film& film, const Film& next);

// `next` must be of the same picture, and after `film` for the fold to be in order.
void foldFilm(Film& film, const Film& next);

struct MergedFilm {
    Film film;
    bool exact = true;  // the bits of a single run; otherwise equal up to rounding
};

// Merges one film or more. Asks for each film once, in order; what planMerge needs are all but its pixels.
MergedFilm mergeFilms(const std::vector<Film>& headers, const std::vector<std::string>& names,
                      const std::function<Film(std::size_t)>& filmAt);
// The same of files, of which two are in memory at a time.
MergedFilm mergeFilms(const std::vector<std::filesystem::path>& files);

}  // namespace glim
