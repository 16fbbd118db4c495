// What the camera saw, for the film's layers.
#ifndef GLIM_ACCESS_FIRST_HIT
#define GLIM_ACCESS_FIRST_HIT

#include "lib/infinity.glsl"
#include "surface.glsl"

FirstHit makeNoFirstHit()
{
    return FirstHit(vec3(0.0), 0.0, vec3(0.0), kInfinity);
}

FirstHit firstHitOf(Surface surface, FlatMaterial material)
{
    float depth = dot(surface.point - sceneCamera.position, sceneCamera.forward);
    return FirstHit(material.baseColor, 1.0, surface.shading, depth);
}

#endif
