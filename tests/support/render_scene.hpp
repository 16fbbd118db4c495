// Renders a scene made in memory on the test device, and estimates its mean with a standard error.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/flatten/flat_scene.hpp"
#include "host/render/renderer.hpp"
#include "host/scene/scene.hpp"

#include <vector>

namespace glim {

FlatScene flattened(const Scene& scene, SplitRule rule = SplitRule::Sah);

// Through the first camera. Renders by both schedules and demands the same bits, unless the settings name a schedule or only one
// can.
Film renderScene(const Scene& scene, const RenderSettings& settings);
Film renderFlat(const FlatScene& flat, const Camera& camera, const RenderSettings& settings);

// With `count` seeds from the settings' on, by one renderer and one schedule.
std::vector<Film> renderSeeds(const Scene& scene, const RenderSettings& settings, std::uint32_t count);

// Square, with samples [0, spp).
RenderSettings squareSettings(std::uint32_t side, std::uint32_t spp);

// GLIM_LONG=1 (tools/test --long) asks for `factor` times the samples.
std::uint32_t samplesFor(std::uint32_t spp, std::uint32_t factor = 25);

// Whether all moments of all pixels are equal, bit by bit.
bool sameBits(const Film& a, const Film& b);

struct MeanEstimate {
    glm::dvec3 mean;
    glm::dvec3 standardError;  // from the block means of every pixel
};

MeanEstimate meanOf(const Film& film);

// Every pixel within 2^-20 (relative) per bounce: for scenes whose estimator has no variance.
void expectEverywhere(const Film& film, const glm::dvec3& truth, int bounces);

// Both means are of independent samples: |a - b| <= z sqrt(se_a^2 + se_b^2) + 2e-5 b in each channel. Prints the ratio.
void expectSameMean(const std::string& name, const Film& a, const Film& b);

// Thresholds (tests/README.md): |mean - truth| <= z se + 2e-5 truth, z for a family of 200 comparisons at level 1e-3. Prints what it
// measured.
void expectMean(const std::string& name, const Film& film, const glm::dvec3& truth);

}  // namespace glim
