// Films as PNGs to look at.
#pragma once

#include "host/render/look.hpp"

#include <filesystem>
#include <string>

namespace glim {

// As the film's --view, which its settings name, asks.
Look lookOf(const Film& film);

// `exposure` in stops, of radiance and albedo.
void writeFilmPng(const std::filesystem::path& path, const Film& film, Look look, double exposure);

}  // namespace glim
