// Camera models: from points on the film to rays, and back.
#ifndef GLIM_LIB_CAMERA
#define GLIM_LIB_CAMERA

#include "projection.glsl"
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
vec3 normalizeSum(vec3 forward, vec3 across)
{
    float square = dot(across, across);
    float secant = sqrt(1.0 + square);
    return forward + (across - forward * (square / (1.0 + secant))) / secant;
}

// `plane`: a point of the image plane.
PathRay cameraRay(FlatCamera camera, vec2 plane)
{
    vec3 across = plane.x * camera.right + plane.y * camera.up;
    return camera.kind == kOrthographic ? PathRay(camera.position + across, kNoPrimitive, camera.forward, 0u)
                                        : PathRay(camera.position, kNoPrimitive, normalizeSum(camera.forward, across), 0u);
}

// The ray through a thin lens. `disk`: the point of the aperture, in the unit disk. All rays of one point meet where the pinhole's ray
// meets the plane of focus (Cook, Porter, Carpenter, "Distributed Ray Tracing", 1984).
PathRay lensRay(FlatCamera camera, vec2 plane, vec2 disk)
{
    vec3 across = plane.x * camera.right + plane.y * camera.up;
    vec3 aperture = disk.x * camera.lensRight + disk.y * camera.lensUp;
    bool orthographic = camera.kind == kOrthographic;
    vec3 origin = camera.position + aperture + (orthographic ? across : vec3(0.0));
    vec3 slope = (orthographic ? vec3(0.0) : across) - aperture * camera.inverseFocus;
    return PathRay(origin, kNoPrimitive, normalizeSum(camera.forward, slope), 0u);
}

// From a point in no scene, away from every scene.
PathRay rayOfNothing()
{
    return PathRay(vec3(1e15), kNoPrimitive, vec3(0.57735027), 0u);
}

// False if the point of the film shows nothing.
bool sphericalRay(FlatCamera camera, uint model, vec2 film, out PathRay ray)
{
    vec3 local;
    bool isSeen = directionFromFilm(camera.projection, model, film, local);
    ray = PathRay(camera.position, kNoPrimitive, normalize(local.x * camera.right + local.y * camera.up + local.z * camera.forward), 0u);
    return isSeen;
}

// A point as the camera sees it.
struct CameraConnection {
    vec3 origin;   // of the ray that sees the point
    vec3 wo;       // unit, from the point towards it
    vec2 film;     // coordinates of that ray
    float weight;  // share of the film per area across wo, 1/m^2; 0: the point is not in front of the camera
};

// The ray of lensRay that leaves the aperture at `disk` and meets p. The weight is the camera's importance times cos / distance^2 on its side
// (pbrt-v3, section 16.1.1); the mean of the film's radiance is radiance times weight, integrated over areas across wo.
CameraConnection connectToPlane(FlatCamera camera, uint model, vec3 p, vec2 disk)
{
    vec3 aperture = disk.x * camera.lensRight + disk.y * camera.lensUp;
    vec3 from = p - camera.position - aperture;
    float depth = dot(from, camera.forward), right2 = dot(camera.right, camera.right), up2 = dot(camera.up, camera.up);
    bool orthographic = camera.kind == kOrthographic;
    // Along the ray, one unit of depth.
    vec3 along = orthographic ? camera.forward - aperture * camera.inverseFocus : from / depth;
    vec3 across = orthographic ? from - depth * along : along - camera.forward + aperture * camera.inverseFocus;
    float stretch2 = dot(along, along), stretch = sqrt(stretch2);  // 1 / cos
    float weight = stretch / sqrt(right2 * up2) * (orthographic ? 1.0 : stretch2 / dot(from, from));
    vec2 plane = vec2(dot(across, camera.right) / right2, dot(across, camera.up) / up2);
    vec3 film = model == kCentredFilm ? vec3(plane, 1.0) : filmFromPlane(camera.projection, model, plane);
    return CameraConnection(p - along * depth, -along / stretch, film.xy, depth > 0.0 ? 0.25 * weight * film.z : 0.0);
}

CameraConnection connectToSphere(FlatCamera camera, uint model, vec3 p)
{
    vec3 from = p - camera.position;
    float square = dot(from, from);
    vec3 direction = from / sqrt(square);
    vec3 film = filmFromDirection(camera.projection, model,
                                  vec3(dot(direction, camera.right), dot(direction, camera.up), dot(direction, camera.forward)));
    return CameraConnection(camera.position, -direction, film.xy, square > 0.0 ? 0.25 * film.z / square : 0.0);
}

CameraConnection connectToCamera(FlatCamera camera, uint model, vec3 p, vec2 disk)
{
    return model >= kFisheye ? connectToSphere(camera, model, p) : connectToPlane(camera, model, p, disk);
}

// Metres along the axis or, where the film shows more than is ahead, from the camera.
float depthFromCamera(FlatCamera camera, uint model, vec3 p)
{
    vec3 from = p - camera.position;
    return model >= kFisheye ? length(from) : dot(from, camera.forward);
}

// The inverse of filmFromPixel.
vec2 pixelFromFilm(vec2 film, vec2 size)
{
    return (vec2(film.x, -film.y) + 1.0) * 0.5 * size;
}

#endif
