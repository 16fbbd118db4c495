// Turns films into pictures to look at.
#pragma once

#include "host/render/aov.hpp"
#include "host/scene/scene.hpp"

#include <filesystem>
#include <optional>

namespace glim {

// The AOV of the film's --view, which its settings name.
Aov getAov(const Film& film);

// Whether `aov` is of surfaces, so that it is transparent where the background is hidden and none is. Others count something.
bool showsSurfaces(Aov aov);

// A file of the kind that the ending of `path` names (host/image/picture_file.hpp). It has alpha if the film's background is hidden, unless
// `aov` counts something, or the kind has none, which is said.
void writeFilmPicture(const std::filesystem::path& path, const Film& film, Aov aov, const Look& look = {});

// A look that need not be complete.
struct LookOptions {
    std::optional<double> exposure = 0.0;  // stops; absent: chosen by the film
    std::optional<Tone> tone;              // absent: chosen by the scene's light
};

// The exposure in stops that shows the log-average luminance of what `aov` shows as .18 (Reinhard, Stark, Shirley and Ferwerda,
// Photographic Tone Reproduction for Digital Images, SIGGRAPH 2002, section 3). Only positive and finite pixels count; 0 without any. It is
// a multiple of .01, so that the number as it is printed gives the same picture.
double chooseExposure(const Film& film, Aov aov);
double chooseExposure(const std::vector<glm::vec3>& pixels);

// Neutral where the built-in studio lights the scene, which it says. None elsewhere.
Tone chooseTone(const Scene& scene);

}  // namespace glim
