// The camera of a picture, for those who compute with its pixels.
#pragma once

#include "host/scene/scene.hpp"

#include <optional>
#include <string>

namespace glim {

// As JSON: `kind` (perspective, orthographic, fisheye or equirectangular), `pose` (camera to world, four rows; the camera looks along -z
// and up is +y), `K` (three rows, pixels; the upper left corner of what is rendered is 0,0), `distortion` or `fisheye` (as OpenCV orders
// them), `halfSize` of an orthographic camera in metres, `crop` (column, row, width and height in the picture that is `whole` pixels
// large), and `time` in seconds of the file's animation. What does not apply is left out. `size`: of what is rendered.
std::string describeFilmCamera(const Camera& camera, const glm::uvec2& size, const glm::dvec3& sceneOrigin, std::optional<double> time);

// OpenEXR's worldToCamera, for row vectors, of such a description; nothing if the text has no pose of four rows of four numbers.
std::optional<glm::mat4> worldToCameraOf(const std::string& description);

}  // namespace glim
