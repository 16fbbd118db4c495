// Each sample of a picture alone.
#pragma once

#include "host/render/film.hpp"
#include "host/render/settings.hpp"
#include "host/scene/scene.hpp"

#include <vector>

namespace glim {

// The films of renders of one sample each, [0, sampleEnd), through the first camera, without what light paths bring. The kernels are
// compiled once. The last film is compared with that of a whole render.
std::vector<Film> renderSingleSamples(const Scene& scene, const RenderSettings& settings);

}  // namespace glim
