// Makes a SurfaceInteraction from a hit: all that shading reads of the surface there.
#ifndef GLIM_ACCESS_INTERACTION
#define GLIM_ACCESS_INTERACTION

#include "lib/frame.glsl"
#include "lib/fresnel.glsl"
#include "lib/offset_point.glsl"
#include "placed_primitive.glsl"
#include "shared/path_types.h"

struct SurfaceInteraction {
    vec3 p;            // on the surface, to within errorBound
    vec3 errorBound;
    vec3 ng;           // unit geometric normal, on the side of wo
    vec3 ns;           // unit shading normal, flipped with ng; an interpolated one may still point away from wo
    vec2 barycentric;  // weights of v1 and v2
    bool front;        // wo is on the front side
    uint material;
    uint primitive;
    uint light;        // index + 1, or 0
    uint triangle;     // as in PlacedPrimitive; with kFeaturePointColors of a sphere its reference
    uint instance;     // that places the triangle, or kNoInstance
};

// The unit normal of a triangle, counter-clockwise front, from its sides one after the other: the two longest cancel least.
vec3 triangleNormalFromSides(vec3 a, vec3 b, vec3 c)
{
    vec3 l = vec3(dot(a, a), dot(b, b), dot(c, c));
    vec3 n = l.x <= l.y && l.x <= l.z ? cross(b, c) : l.y <= l.z ? cross(c, a) : cross(a, b);
    return normalizeSafely(n);
}

vec3 triangleNormal(vec3 v0, vec3 v1, vec3 v2)
{
    return triangleNormalFromSides(v1 - v0, v2 - v1, v0 - v2);
}

// The unit normal of a placed triangle. It is placed as a normal, because rounding the sides would tilt a thin triangle. A mirrored front
// stays the front.
vec3 placedNormal(PlacedPrimitive placed)
{
    vec3 n = triangleNormal(toFloats(placed.ref.t0), toFloats(placed.ref.t1), toFloats(placed.ref.t2));
    if (hasFeature(kFeatureInstances) && placed.instance != kNoInstance) {
        n = normalizeSafely(placeNormal(fetchInstance(placed.instance), n));
    }
    return n;
}

// Interpolates the section of the vertices that begins at texel `first` (scene_types.h).
vec4 vertexAttribute(uint first, uint triangle, vec2 barycentric)
{
    ivec3 vertices = ivec3(texelFetch(sceneTriangles, int(triangle)).xyz) + int(first);
    return uintBitsToFloat(texelFetch(sceneVertices, vertices.x)) * (1.0 - barycentric.x - barycentric.y) +
           uintBitsToFloat(texelFetch(sceneVertices, vertices.y)) * barycentric.x +
           uintBitsToFloat(texelFetch(sceneVertices, vertices.z)) * barycentric.y;
}

// The unit vector along v, or 0.
vec3 normalizeOrZero(vec3 v)
{
    float square = dot(v, v);
    return square > 0.0 ? v / sqrt(square) : vec3(0.0);
}

// A normal or tangent of a vertex as its instance places it.
vec4 placedDirection(InstanceData instance, uint at, bool isNormal)
{
    vec4 direction = uintBitsToFloat(texelFetch(sceneVertices, int(at)));
    float tangentSign = !isNormal && instance.mirrors != 0u ? -1.0 : 1.0;  // cross(normal, tangent) changes its sign
    return vec4(normalizeOrZero(isNormal ? placeNormal(instance, direction.xyz) : placeVector(instance, direction.xyz)),
                tangentSign * direction.w);
}

// Interpolated normals or tangents of the vertices, in the section that begins at texel `first`. Each is placed and made unit before, as
// where meshes are not shared.
vec4 vertexDirection(uint first, bool isNormal, uint triangle, uint instance, vec2 barycentric)
{
    if (hasFeature(kFeatureInstances) && instance != kNoInstance) {
        InstanceData data = fetchInstance(instance);
        uvec3 vertices = texelFetch(sceneTriangles, int(triangle)).xyz + first;
        return placedDirection(data, vertices.x, isNormal) * (1.0 - barycentric.x - barycentric.y) +
               placedDirection(data, vertices.y, isNormal) * barycentric.x + placedDirection(data, vertices.z, isNormal) * barycentric.y;
    }
    return vertexAttribute(first, triangle, barycentric);
}

// Interpolated vertex normal of a triangle, or zero where it is flat.
vec3 vertexNormal(uint triangle, uint instance, vec2 barycentric)
{
    return vertexDirection(0u, true, triangle, instance, barycentric).xyz;
}

SurfaceInteraction interactionWithSphere(PrimitiveRef ref, uint index, vec3 near)
{
    vec3 center = sphereCenter(ref, near);
    float radius = sphereRadius(ref);
    vec3 n = near - center;
    n = n / length(n);
    vec3 errorBound = sphereErrorBound(center, radius);
    if (isLine(ref)) {
        errorBound += lineErrorBound(toFloats(ref.t1), radius);
    }
    return SurfaceInteraction(center + radius * n, errorBound, n, n, vec2(0.0), true, getMaterial(ref),
                              getPrimitive(ref), ref.t2.w, hasFeature(kFeaturePointColors) ? index : 0u, kNoInstance);
}

SurfaceInteraction interactionWithTriangle(PlacedPrimitive placed, PathRay ray, PathHit hit)
{
    PrimitiveRef ref = placed.ref;
    PlacedTriangle triangle = placedTriangle(placed);
    vec3 v0 = triangle.v0, e1 = triangle.e1, e2 = triangle.e2;
    vec3 n = placedNormal(placed);
    vec3 errorBound = triangleErrorBound(v0, e1, e2, hasFeature(kFeatureLargeTriangles));
    if (hasFeature(kFeatureInstances) && placed.instance != kNoInstance) {
        errorBound += fetchInstance(placed.instance).errorBound;
    }
    vec3 p = trianglePoint(v0, e1, e2, hit.barycentric);
    if (hasFeature(kFeatureLargeTriangles)) {
        bool nearby = isNearby(hit.t, e1, e2);
        p = nearby ? moveWithinPlane(p, ray.origin + ray.direction * hit.t, n) : p;
        errorBound *= nearby ? 2.0 : 1.0;
    }
    SurfaceInteraction si = SurfaceInteraction(p, errorBound, n, n, hit.barycentric, true, getMaterial(ref), getPrimitive(ref),
                                               ref.t2.w, placed.triangle, placed.instance);
    if (hasFeature(kFeatureSmooth)) {
        vec3 smoothed = vertexNormal(placed.triangle, placed.instance, hit.barycentric);
        float square = dot(smoothed, smoothed);
        si.ns = square > 0.0 ? smoothed / sqrt(square) : n;
    }
    return si;
}

// Once per hit. Both normals are flipped if the geometric one is not on the side of wo = -ray.direction.
SurfaceInteraction makeSurfaceInteraction(PathRay ray, PathHit hit)
{
    PlacedPrimitive placed = fetchPlacedPrimitive(hit.primitiveRef);
    SurfaceInteraction si;
    if (isSphere(placed.ref)) {
        si = interactionWithSphere(placed.ref, hit.primitiveRef, ray.origin + ray.direction * hit.t);
    } else {
        si = interactionWithTriangle(placed, ray, hit);
    }
    si.front = dot(si.ng, ray.direction) < 0.0;
    float side = si.front ? 1.0 : -1.0;
    si.ng *= side;
    si.ns *= side;
    return si;
}

// The shading normal, or the geometric one if that points away from wo, so that no silhouette goes black.
vec3 visibleNormal(SurfaceInteraction si, vec3 wo)
{
    return dot(si.ns, wo) > 0.0 ? si.ns : si.ng;
}

// The shading normal, bent towards wo as little as is needed for a mirror to reflect wo to the outer side of the surface, by a small angle at
// least; otherwise normal maps and coarse smooth meshes have black rims. As Cycles does; the threshold is its own. Needs dot(ns, wo) > 0.
vec3 reflectingNormal(vec3 ns, vec3 ng, vec3 wo)
{
    vec3 mirrored = reflectAbout(wo, ns);
    float least = min(0.9 * dot(ng, wo), 0.01);
    float outwards = dot(mirrored, ng);
    if (outwards >= least) {
        return ns;
    }
    vec3 raised = mirrored + ng * (least - outwards);
    vec3 bent = wo + raised / length(raised);
    return bent / length(bent);
}

// Radiance that the surface itself sends towards wo.
vec3 emittedRadiance(SurfaceInteraction si, MaterialData material)
{
    return si.light != 0u && (si.front || (material.flags & kDoubleSided) != 0u) ? material.emission : vec3(0.0);
}

// The point, moved to the side of the surface that w points to, beyond its error bound.
vec3 offsetRayOrigin(SurfaceInteraction si, vec3 w)
{
    vec3 n = dot(w, si.ng) >= 0.0 ? si.ng : -si.ng;
    return offsetPoint(si.p, n, si.errorBound);
}

PathRay spawnRay(SurfaceInteraction si, vec3 wi)
{
    return PathRay(offsetRayOrigin(si, wi), si.primitive, wi, 0u);
}

#endif
