// Films of one picture over different samples or rows, to be merged: what is asked for, and what carries it out.
#pragma once

#include "host/job/look_options.hpp"
#include "host/render/merge_films.hpp"
#include "host/render/regroup.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace glim {

class Json;

struct MergeJob {
    std::vector<std::filesystem::path> inputs;
    std::optional<std::filesystem::path> output;  // without one the films are only looked at
    std::vector<LightWeight> lights;              // of films with light groups
    PictureFiles pictures;
    LookOptions look;

    // By which messages name the result: the film, else the first picture. There must be one of them.
    const std::filesystem::path& mainFile() const { return output ? *output : pictures.front(); }
};

// `job` must outlive the table.
void addMergeOptions(OptionTable& table, MergeJob& job);

// Writes the files. Throws InputError.
MergedFilm carryOut(const MergeJob& job);

// {"samples": "0:512", "exact": true, "complete": true, "estimate": {...}}. `exact`: the bits of a single run. `estimate` is that of
// reports (describeEstimate), and null while some pixel's error is unknown.
Json describe(const MergedFilm& merged);

}  // namespace glim
