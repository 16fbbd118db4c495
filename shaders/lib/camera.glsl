// From the film to rays.
#ifndef GLIM_LIB_CAMERA
#define GLIM_LIB_CAMERA

#include "frame.glsl"
#include "shared/path_types.h"
#include "shared/scene_types.h"

//   pixel (0,0) ---- x           film (-1,1) ---- (1,1)
//        |                            |             |
//        y                        (-1,-1) ---- (1,-1)
// `position` in pixels, [0, size).
vec2 filmFromPixel(vec2 position, vec2 size)
{
    vec2 film = 2.0 * position / size - 1.0;
    return vec2(film.x, -film.y);
}

PathRay cameraRay(FlatCamera camera, vec2 film)
{
    vec3 across = film.x * camera.right + film.y * camera.up;
    return camera.kind == kOrthographic
               ? PathRay(camera.position + across, kNoRecord, camera.forward)
               : PathRay(camera.position, kNoRecord, normalizeSafely(camera.forward + across));
}

#endif
