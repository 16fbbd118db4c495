// The picture that a bench measures against.
#pragma once

#include "host/measure/picture.hpp"
#include "host/render/film.hpp"
#include "host/render/settings.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace glim {

// The reference has this many times the samples of the last point: its noise adds 1/128 to that point's error.
inline constexpr std::uint32_t kReferenceFactor = 128;

// Settings of a reference for benches of at most `samples`: the same light as in `settings`, with MIS and Sobol' points and without any
// bias, and a seed far from theirs.
RenderSettings referenceSettings(const RenderSettings& settings, std::uint32_t samples);

// Whether `file` is a film of the picture that `scene` (a film's identity) and `settings` (of referenceSettings) name, with as
// many samples or more.
bool isReference(const std::filesystem::path& file, const std::string& scene, const RenderSettings& settings);

// Refuses (InputError) another size and, if glim made the file, another picture than `scene` or a seed that is one of `seeds`.
Picture readReference(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height, const std::string& scene,
                      const std::vector<std::uint32_t>& seeds);

}  // namespace glim
