// Films as PNGs to look at.
#pragma once

#include "host/render/aov.hpp"

#include <filesystem>
#include <string>

namespace glim {

// The AOV of the film's --view, which its settings name.
Aov aovOf(const Film& film);

// `exposure` is in stops and applies to radiance and albedo.
void writeFilmPng(const std::filesystem::path& path, const Film& film, Aov aov, double exposure);

}  // namespace glim
