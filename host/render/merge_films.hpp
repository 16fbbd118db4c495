// Films of the same picture over disjoint sample ranges, folded in order of their samples.
//
// A render is the left fold of its pages of kPageSamples. So a merge gives the bits of the single run exactly if the first
// film is one contiguous run and each further one continues it from a page's beginning by at most that page. Such ranges
// are joined ("0:512"); ranges that were merged to rounding stay apart ("0:512 512:1024"), so that a film never claims
// the bits of a run it does not equal. A block cut in two by the ranges counts as two blocks.
#pragma once

#include "host/render/film.hpp"

#include <filesystem>

namespace glim {

struct MergePlan {
    std::vector<std::size_t> order;  // indices of the films, by their first sample
    bool exact = true;
};

// Only the headers are looked at. Refuses (InputError, by `names`) different pictures and overlapping samples.
MergePlan planMerge(const std::vector<Film>& films, const std::vector<std::string>& names);

// Are both of the same picture, and is a sample in both?
bool shareSamples(const Film& a, const Film& b);

// Does `next` continue `film` with the bits of a single run?
bool continuesExactly(const Film& film, const Film& next);

// `next` must be of the same picture, and after `film` for the fold to be in order.
void foldFilm(Film& film, const Film& next);

struct MergedFilm {
    Film film;
    bool exact = true;  // the bits of a single run; otherwise equal to rounding
};

// Reads the files one after the other: two films are in memory at a time.
MergedFilm mergeFilms(const std::vector<std::filesystem::path>& files);

}  // namespace glim
