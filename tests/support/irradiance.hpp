// Irradiance on receivers, estimated by the renderer's light sampling (tests/kernels/light_test.comp), and its true value.
#pragma once

#include "host/scene/scene.hpp"

namespace glim {

struct Receiver {
    glm::vec3 point;
    glm::vec3 normal;
    double truth = 0.0;   // W/m^2, red
    float height = 0.0F;  // above the point and free of surfaces, where the point is on one; 0: a point in the air
};

struct IrradianceEstimate {
    double mean, standardError;
    double least, most;     // of single samples
    double pdf;             // of some sample
    double pdfError;        // largest relative difference of sampleLight's pdf and pdfSurfaceLight
    std::size_t compared;   // samples in pdfError
    std::size_t elsewhere;  // samples towards a surface light whose direction meets something else
    double surfaceError;    // metres
};

// 131,072 samples each (20 times as many with GLIM_LONG, 4e6 with GLIM_HARD).
std::vector<IrradianceEstimate> estimateIrradiance(const Scene& scene, const std::vector<Receiver>& receivers);

// Thresholds (tests/README.md): |mean - truth| <= z se + 2e-5 truth; a density that is found must be the one it was sampled with
// within `densityTolerance`. Prints the errors.
std::vector<IrradianceEstimate> expectIrradiance(const char* name, const Scene& scene, const std::vector<Receiver>& receivers,
                                                 double densityTolerance = 1e-4);

// As above where every sample is the truth, within 2^-20.
void expectExactIrradiance(const char* name, const Scene& scene, const std::vector<Receiver>& receivers);

}  // namespace glim
