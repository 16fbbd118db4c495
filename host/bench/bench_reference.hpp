// The picture that a bench measures against.
#pragma once

#include "host/measure/picture.hpp"
#include "host/render/film.hpp"
#include "host/render/settings.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace glim {

// Times the samples of the last point: noise adds 1/128 to its error.
inline constexpr std::uint32_t kReferenceFactor = 128;

// Of the same light as `settings`, for benches of at most `samples`: MIS, Sobol' points and nothing that is a bias, whatever
// `settings` ask, and a seed far from theirs.
RenderSettings referenceSettings(const RenderSettings& settings, std::uint32_t samples);

// Whether a file is there that writeFilm wrote of the picture that `scene` (a film's identity) and `settings` of
// referenceSettings name, with as many samples or more.
bool isReference(const std::filesystem::path& file, const std::string& scene, const RenderSettings& settings);

// Refuses (InputError) another size and, if glim made it, another picture than `scene` or samples of one of `seeds`.
Picture readReference(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height, const std::string& scene,
                      const std::vector<std::uint32_t>& seeds);

}  // namespace glim
