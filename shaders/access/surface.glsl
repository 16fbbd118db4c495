// From a hit to what shading needs.
#ifndef GLIM_ACCESS_SURFACE
#define GLIM_ACCESS_SURFACE

#include "lib/frame.glsl"
#include "lib/offset_point.glsl"
#include "scene.glsl"
#include "shared/path_types.h"

struct Surface {
    vec3 point;       // on the surface, to within errorBound
    vec3 errorBound;
    vec3 geometric;   // unit normal on the side of wo
    vec3 shading;     // unit; interpolated ones may look away from wo (turnToViewer)
    bool front;       // wo is on the front side
    uint material;
    uint emitter;     // index + 1, or 0
    uint primitive;
};

// The unit normal of a triangle, counter-clockwise front; from its two longest edges, which cancel least.
vec3 triangleNormal(vec3 v0, vec3 v1, vec3 v2)
{
    vec3 a = v1 - v0;
    vec3 b = v2 - v1;
    vec3 c = v0 - v2;
    vec3 l = vec3(dot(a, a), dot(b, b), dot(c, c));
    vec3 n = l.x <= l.y && l.x <= l.z ? cross(b, c) : l.y <= l.z ? cross(c, a) : cross(a, b);
    return normalizeSafely(n);
}

// Interpolated vertex normal, or zero where the triangle is flat.
vec3 vertexNormal(uint record, vec2 barycentric)
{
    int at = int(record * kRecordTexels);
    return floatsOf(texelFetch(sceneNormals, at)) * (1.0 - barycentric.x - barycentric.y) +
           floatsOf(texelFetch(sceneNormals, at + 1)) * barycentric.x +
           floatsOf(texelFetch(sceneNormals, at + 2)) * barycentric.y;
}

Surface surfaceOfSphere(Record record, vec3 near)
{
    vec3 center = floatsOf(record.t0);
    float radius = uintBitsToFloat(record.t1.x);
    vec3 n = near - center;
    n = n / length(n);
    return Surface(center + radius * n, sphereErrorBound(center, radius), n, n, true, materialOf(record),
                   record.t2.w, primitiveOf(record));
}

Surface surfaceOfTriangle(Record record, uint index, vec2 barycentric)
{
    vec3 v0 = floatsOf(record.t0);
    vec3 e1 = floatsOf(record.t1) - v0;
    vec3 e2 = floatsOf(record.t2) - v0;
    vec3 n = triangleNormal(v0, floatsOf(record.t1), floatsOf(record.t2));
    Surface surface = Surface(trianglePoint(v0, e1, e2, barycentric), triangleErrorBound(v0, e1, e2), n, n, true, materialOf(record),
                              record.t2.w, primitiveOf(record));
    if (kSmooth) {
        vec3 smoothed = vertexNormal(index, barycentric);
        float square = dot(smoothed, smoothed);
        surface.shading = square > 0.0 ? smoothed / sqrt(square) : n;
    }
    return surface;
}

// The surface that `ray` met. Both normals are turned over if the geometric one is not on the side of wo = -ray.direction.
Surface surfaceAt(PathRay ray, PathHit hit)
{
    Record record = fetchRecord(hit.record);
    Surface surface;
    if (isSphere(record)) {
        surface = surfaceOfSphere(record, ray.origin + ray.direction * hit.t);
    } else {
        surface = surfaceOfTriangle(record, hit.record, hit.barycentric);
    }
    surface.front = dot(surface.geometric, ray.direction) < 0.0;
    float side = surface.front ? 1.0 : -1.0;
    surface.geometric *= side;
    surface.shading *= side;
    return surface;
}

// A shading normal that looks away from wo gives way to the geometric one, so that no silhouette goes black.
void turnToViewer(inout Surface surface, vec3 wo)
{
    if (!(dot(surface.shading, wo) > 0.0)) {
        surface.shading = surface.geometric;
    }
}

// Radiance that the surface itself sends towards wo.
vec3 emittedRadiance(Surface surface, FlatMaterial material)
{
    return surface.emitter != 0u && (surface.front || material.doubleSided != 0u) ? material.emission : vec3(0.0);
}

// Origin of a ray that leaves the surface along wi.
vec3 leavePoint(Surface surface, vec3 wi)
{
    vec3 n = dot(wi, surface.geometric) >= 0.0 ? surface.geometric : -surface.geometric;
    return offsetPoint(surface.point, n, surface.errorBound);
}

#endif
