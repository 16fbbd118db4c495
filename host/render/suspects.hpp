// Suspects: the brightest samples of a picture, which are its firefly candidates.
#pragma once

#include "host/render/renderer.hpp"

namespace glim {

struct Suspect {
    std::uint32_t pixel;  // index in the picture
    std::uint32_t sampleIndex;
    glm::vec3 radiance;
    double luminance;
    double shareOfPixel;    // of the sum of its pixel's luminances
    double shareOfPicture;  // of the sum of the pixels' means
};

// Returns the brightest samples of `film`, which `renderer` has rendered: as many as its settings ask for, at most one per pixel, none of
// them black, the brightest first. Ties go to the lower pixel and, within a pixel, to the lower sample.
std::vector<Suspect> findSuspects(Renderer& renderer, const Film& film);

}  // namespace glim
