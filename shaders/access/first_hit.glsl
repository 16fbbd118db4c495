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
    bool isCatcher = hasFeature(kFeatureCatcher) && (material.flags & kCatcher) != 0u;
    return FirstHit(material.baseColor, isCatcher ? -1.0 : 1.0, visibleNormal(si, wo), depth);
}

#endif
