// The media that transmissive solids enclose, numbered.
#pragma once

#include "host/scene/scene.hpp"
#include "shaders/shared/scene_types.h"

#include <vector>

namespace glim {

struct Media {
    std::vector<MediumData> media;           // number 1 is the first; equal ones are one
    std::vector<ScatteringData> scattering;  // of each of them
    std::vector<std::uint32_t> ofMaterial;   // number by material; 0: none
    // Whether paths have to know which medium they are in: some medium absorbs, scatters or disperses, or solids of different media
    // overlap.
    bool tracked = false;
    bool disperses = false;
};

// The media of the materials that are used. Throws InputError if there are more than kMaxMedia.
Media findMedia(const Scene& scene);

}  // namespace glim
