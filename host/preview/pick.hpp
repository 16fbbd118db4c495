// What is printed of a pixel that is clicked.
#pragma once

#include "host/preview/refiner.hpp"
#include "host/render/aov.hpp"
#include "host/render/camera_rays.hpp"
#include "host/render/describe_primitive.hpp"

#include <memory>
#include <optional>
#include <string>

namespace glim {

struct Pick {
    glm::dvec3 position;  // world coordinates
    double distance;      // metres from the ray's origin
    double depth;         // the same along the camera's axis
    PrimitiveDescription primitive;
};

// Keeps the kernels of one click for the next.
class Picker {
public:
    // The surface behind the centre of a pixel of a window of this size, seen by the refiner's camera.
    std::optional<Pick> pick(Refiner& refiner, const PreparedScene& prepared, const glm::uvec2& pixel, const glm::uvec2& size);

private:
    std::shared_ptr<const CameraRayKernels> kernels_;
};

// The surface and its place: "nothing" if there is none.
std::string describeSurface(const std::optional<Pick>& found);
// For example "; 64 samples, mean (1, 1, 1) W/(sr m^2), standard error (.1, .1, .1)".
std::string describeSamples(Refiner& refiner, const glm::uvec2& pixel, Aov aov);

}  // namespace glim
