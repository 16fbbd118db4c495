// Aims light paths at targets, the bounding spheres of specular objects. Of a target, xyz is the centre and w the radius.
#ifndef GLIM_LIB_CAUSTIC_TARGET
#define GLIM_LIB_CAUSTIC_TARGET

#include "cone.glsl"
#include "frame.glsl"
#include "light_importance.glsl"
#include "punctual.glsl"

const uint kEmitsAround = 0u;     // a point light
const uint kEmitsInFront = 1u;    // one side of a surface, by the cosine
const uint kEmitsFromBoth = 2u;   // both sides
const uint kEmitsSpot = 3u;

// Float's rounding of a cosine, so that a spot that grazes a target still reaches it.
const float kSlack = 1e-6;

// A point that emits.
struct Emitter {
    vec3 p;
    uint profile;             // kEmitsAround ...
    vec3 axis;                // unit: normal or direction
    float inner, outer;       // of a spot: versines (punctual.glsl)
};

// The directions from an emitter to a target.
struct TargetCone {
    vec3 axis;         // unit
    float sin2;        // of the half angle
    bool around;       // the emitter is within the target: all directions in which it emits
    float solidAngle;
    float importance;  // at least what the emitter may send there, up to a factor that all targets share
};

TargetCone makeTargetCone(vec4 target, Emitter emitter)
{
    vec3 towards = target.xyz - emitter.p;
    float distance2 = dot(towards, towards), radius2 = target.w * target.w;
    TargetCone cone;
    cone.around = !(distance2 > radius2);
    cone.sin2 = cone.around ? 0.0 : radius2 / distance2;
    cone.axis = cone.around ? emitter.axis : towards / sqrt(distance2);
    float around = emitter.profile == kEmitsInFront ? 2.0 * kPi : 4.0 * kPi;
    cone.solidAngle = cone.around ? around : 2.0 * kPi * oneMinusCosCone(cone.sin2);
    float cosine = dot(emitter.axis, cone.axis);
    cosine = emitter.profile == kEmitsFromBoth ? abs(cosine) : cosine;
    cosine = clamp(cosine, -1.0, 1.0);
    float nearest = cosSubtractClamped(cosine, sinFromCos(cosine), sqrt(1.0 - cone.sin2), sqrt(cone.sin2));
    float most = emitter.profile == kEmitsSpot     ? spotFalloff(max(0.0, 1.0 - nearest - kSlack), emitter.inner, emitter.outer)
                 : emitter.profile == kEmitsAround ? 1.0
                                                   : max(nearest, 0.0);
    cone.importance = cone.solidAngle * (cone.around ? 1.0 : most);
    return cone;
}

// By versines: cosines of cones below .001 are 1 to within a few roundings.
bool isInCone(TargetCone cone, vec3 w)
{
    return cone.around || versine(w, cone.axis) <= oneMinusCosCone(cone.sin2);
}

// Uniform over the cone's solid angle; u in [0, 1)^2.
vec3 sampleTargetCone(TargetCone cone, Emitter emitter, vec2 u)
{
    vec3 local = cone.around ? sampleSphere(u) : sampleCone(u, cone.sin2);
    bool flips = cone.around && emitter.profile == kEmitsInFront && local.z < 0.0;
    local.z = flips ? -local.z : local.z;
    return worldFromFrame(makeFrame(cone.axis), local);
}

#endif
