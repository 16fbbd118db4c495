// From the film to rays.
#ifndef GLIM_LIB_CAMERA
#define GLIM_LIB_CAMERA

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

// The unit vector along forward + across. `forward` is a unit vector, `across` is perpendicular to it. Computed as forward plus a
// correction, which is small in a narrow field of view, so only the last sum rounds (0.05 pixel of 0.1 degree / 1920, against 0.1 by
// normalize).
vec3 aside(vec3 forward, vec3 across)
{
    float square = dot(across, across);
    float length_ = sqrt(1.0 + square);
    return forward + (across - forward * (square / (1.0 + length_))) / length_;
}

PathRay cameraRay(FlatCamera camera, vec2 film)
{
    vec3 across = film.x * camera.right + film.y * camera.up;
    return camera.kind == kOrthographic ? PathRay(camera.position + across, kNoPrimitive, camera.forward, 0u)
                                        : PathRay(camera.position, kNoPrimitive, aside(camera.forward, across), 0u);
}

// The ray through a thin lens. `disk`: the point of the aperture, in the unit disk. All rays of one film point meet where the pinhole's ray
// meets the plane of focus (Cook, Porter, Carpenter, "Distributed Ray Tracing", 1984).
PathRay lensRay(FlatCamera camera, vec2 film, vec2 disk)
{
    vec3 across = film.x * camera.right + film.y * camera.up;
    vec3 aperture = disk.x * camera.lensRight + disk.y * camera.lensUp;
    bool orthographic = camera.kind == kOrthographic;
    vec3 origin = camera.position + aperture + (orthographic ? across : vec3(0.0));
    vec3 turn = (orthographic ? vec3(0.0) : across) - aperture * camera.inverseFocus;
    return PathRay(origin, kNoPrimitive, aside(camera.forward, turn), 0u);
}

#endif
