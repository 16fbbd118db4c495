// What the camera saw, for the film's layers.
#ifndef GLIM_ACCESS_FIRST_HIT
#define GLIM_ACCESS_FIRST_HIT

#include "lib/camera.glsl"
#include "lib/finite.glsl"
#include "interaction.glsl"
#include "parameters.glsl"

FirstHit makeNoFirstHit()
{
    return FirstHit(vec3(0.0), 0.0, vec3(0.0), kInfinity);
}

FirstHit makeFirstHit(SurfaceInteraction si, MaterialData material, vec3 wo)
{
    float depth = depthFromCamera(render.camera, kProjection, si.p);
    return FirstHit(material.baseColor, 1.0, visibleNormal(si, wo), depth);
}

#endif
