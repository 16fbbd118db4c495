// Films with and without light paths, and how their light is compared.
#pragma once

#include "host/measure/picture.hpp"
#include "tests/support/render_scene.hpp"

#include <string>

namespace glim {

// Of each z-test: some 20 pictures, two tests each.
inline constexpr double kCausticsLevel = 1e-3 / 40;

// By the persistent schedule alone.
Film renderCaustics(const FlatScene& flat, const FlatCamera& camera, RenderSettings settings, bool byLightPaths);

// In their means and in blocks of pixels.
void expectAgreement(const std::string& name, const Picture& picture, const Picture& reference);

double meanOfSplats(const Film& film);

}  // namespace glim
