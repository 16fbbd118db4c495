// The media along a path: what they absorb, and the indices on the two sides of a surface.
#ifndef GLIM_ACCESS_MEDIA
#define GLIM_ACCESS_MEDIA

#include "lib/dispersion.glsl"
#include "lib/hash.glsl"
#include "lib/finite.glsl"
#include "lib/media.glsl"
#include "lib/portable.glsl"
#include "material.glsl"
#include "pass.glsl"
#include "scattering.glsl"

// The share of light that is left after `lightDistance` metres within a ray's innermost medium.
vec3 mediaTransmittance(uint media, float lightDistance)
{
    uint medium = innermost(media);
    if (!hasFeature(kFeatureMedia) || medium == 0u) {
        return vec3(1.0);
    }
    vec3 depth = fetchMedium(render.firstMedium, medium).extinction * min(lightDistance, 1e30);
    return vec3(portableExp(-depth.r), portableExp(-depth.g), portableExp(-depth.b));
}

// The same of a path's ray. Where the medium scatters, its throughput has it (throughputAt).
vec3 pathTransmittance(uint media, float lightDistance)
{
    return scatters(media) ? vec3(1.0) : mediaTransmittance(media, lightDistance);
}

// The share that is left along a shadow ray that leaves the surface to the side of wo or, through a rough one, to the other.
vec3 mediaTransmittance(uint media, SurfaceInteraction si, uint medium, ShadowRay ray)
{
    bool crosses = medium != 0u && dot(ray.direction, si.ng) < 0.0;
    uint along = crosses ? mediaBeyond(media, medium, si.front) : media;
    return mediaTransmittance(along, ray.tMax > 1.0 ? kInfinity : length(ray.direction));
}

float computeIor(uint medium, Wavelength wavelength)
{
    if (medium == 0u) {
        return 1.0;
    }
    MediumData data = fetchMedium(render.firstMedium, medium);
    return hasFeature(kFeatureDispersion) && data.spread > 0.0 ? iorAt(wavelength.nm, data.ior, data.spread) : data.ior;
}

bool isDispersive(uint medium)
{
    return medium != 0u && fetchMedium(render.firstMedium, medium).spread > 0.0;
}

// Sets the indices on the two sides, and where the surface disperses, the path's colour. `media`: of the ray that arrives.
void setIndices(SampleId id, SurfaceInteraction si, inout SurfaceMaterial material, inout uint media, inout vec3 throughput)
{
    uint medium = getMedium(material);
    if (!hasFeature(kFeatureMedia) || medium == 0u) {
        return;
    }
    uint here = si.front || isInMedium(media, medium) ? innermost(media) : medium;
    uint beyond = innermost(mediaBeyond(media, medium, si.front));
    Wavelength wavelength = Wavelength(587.6, vec3(1.0));
    if (hasFeature(kFeatureDispersion)) {
        if ((media & kHasWavelength) != 0u || isDispersive(here) || isDispersive(beyond)) {
            uvec4 bits = hash4(uvec4(id.pixel, id.index, kDimensionWavelength, id.seed));
            wavelength = sampleWavelength(unitFloat(bits.xy));
            throughput *= (media & kHasWavelength) != 0u ? vec3(1.0) : wavelength.color;
            media |= kHasWavelength;
        }
    }
    material.iors = vec2(computeIor(here, wavelength), computeIor(beyond, wavelength));
}

#endif
