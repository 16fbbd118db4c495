// Names, boxes and pixels of the instances that a picture shows, for those who train on it: JSON with COCO's keys.
#pragma once

#include "host/json.hpp"
#include "host/render/surfaces.hpp"

#include <string>

namespace glim {

// Pixels count by the ray through their centre. Boxes are x, y, width and height in pixels.
//
// instances     all of the scene: `id`, `name`, `node`, `mesh` (indices in the file, or null), `category_id`; `pixels` and `bbox` of what
// is
//               seen, `full_pixels` and `full_bbox` of what would be seen in the picture without the others, `visible`: their ratio; null
//               for no pixel
// images, categories, annotations   as of COCO: a category is a mesh of the file (or, without a name, its first node), an annotation an
// instance that is seen, with its
//               `segmentation` as run lengths of columns. Ids of categories and annotations begin at 1
//
// `fileName`: the picture's.
Json describeSeenInstances(SurfaceTracer& tracer, const SceneInstances& instances, const glm::uvec2& size, const std::string& fileName);

}  // namespace glim
