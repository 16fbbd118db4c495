// A vertex of a light path that has met a specular surface: its light is sent to the camera and scatters on.
#ifndef GLIM_ACCESS_LIGHT_VERTEX
#define GLIM_ACCESS_LIGHT_VERTEX

#include "bsdf.glsl"
#include "lib/camera.glsl"
#include "lib/roulette.glsl"
#include "media.glsl"
#include "next_ray.glsl"

float computeContinuation(BsdfSample s, vec3 throughput, float etaScale, uint bounce)
{
    return continuationProbability(throughput, 1.0, bounce);
}

struct LightVertex {
    bool hasSplat;
    uint pixel;
    ShadowRay cameraRay;  // its contribution: to a sample of the pixel, over the path's flux
    float cameraRatio;    // as state.pdf, of the whole path; only with comparesPaths
    bool hasNextRay;
    PathRay ray;      // the next one
    PathState state;  // and its state; pdf: that of this path from the light over that of a camera path; only with comparesPaths
};

// The surface as seen from its other side.
void flip(inout SurfaceInteraction si, inout SurfaceMaterial material)
{
    si.ng = -si.ng;
    si.ns = -si.ns;
    si.front = !si.front;
    material.coatNormal = -material.coatNormal;
    material.iors = material.iors.yx;
}

// The BSDF that a path from the camera, which leaves towards wo, has at the point.
Bsdf bsdfTowards(vec3 wo, SurfaceInteraction si, SurfaceMaterial material)
{
    if (dot(wo, si.ng) < 0.0) {
        flip(si, material);
    }
    return makeBsdf(si, material, wo);
}

// The ratio of the BSDF of particles to that of radiance where the shading normal is not the geometric one (Veach 1997, section 5.3.2).
// Here from f * cos against ns of the light's direction wi, and per area across wo.
float adjointFactor(vec3 ng, vec3 wi, vec3 wo)
{
    return abs(dot(wo, ng)) / max(abs(dot(wi, ng)), 1e-12);
}

// A specular sample's weight for particles over that for radiance: without refraction's scaling, and corrected as above.
float specularFactor(BsdfSample s, vec3 wi, vec3 ng, vec3 ns)
{
    bool refracts = (s.flags & kBsdfTransmission) != 0u;
    float shading = refracts ? abs(dot(wi, ns)) / max(abs(dot(s.wi, ns)), 1e-12) : 1.0;
    return s.eta * s.eta * shading * adjointFactor(ng, wi, s.wi);
}

BounceNumbers sampleLightBounceNumbers(SampleId id, uint bounce)
{
    uint dimension = kDimensionLightBounce + bounce * kDimensionsPerBounce;
    vec2 direction = unitFloat(independentPair(id, dimension + kDimensionBsdf));
    vec2 lobe = unitFloat(independentPair(id, dimension + kDimensionLobe));
    return BounceNumbers(direction, lobe.x, lobe.y);
}

CameraConnection connect(SampleId id, SurfaceInteraction si, uint bounce)
{
    vec2 disk = vec2(0.0);
    if (kLens) {
        disk = sampleDisk(unitFloat(independentPair(id, kDimensionCameraLens + bounce)));
    }
    return connectToCamera(render.camera, kProjection, si.p, disk);
}

// Whether the picture shows the connection's film coordinates; `pixel` is then where.
bool isInPicture(CameraConnection connection, out uint pixel)
{
    vec2 at = pixelFromFilm(connection.film, vec2(render.width, render.height));
    bool inside = connection.weight > 0.0 && at.x >= 0.0 && at.y >= 0.0 && at.x < float(render.width) && at.y < float(render.height);
    uvec2 place = uvec2(inside ? at : vec2(0.0));
    pixel = min(place.y, render.height - 1u) * render.width + min(place.x, render.width - 1u);
    return inside;
}

// state.throughput: over the path's flux. The first scattering must be specular, or the path ends.
LightVertex shadeLightVertex(SampleId id, PathRay ray, PathHit hit, PathState state)
{
    vec3 wi = -ray.direction;
    SurfaceInteraction si = makeSurfaceInteraction(ray, hit);
    SurfaceMaterial material = makeSurfaceMaterial(si);
    if (hasFeature(kFeatureMedia)) {
        state.throughput *= mediaTransmittance(ray.media, hit.t);
        setIndices(id, si, material, ray.media, state.throughput);
    }
    CameraConnection connection = connect(id, si, state.bounce);
    LightVertex vertex;
    bool inPicture = isInPicture(connection, vertex.pixel), isFirst = state.bounce == 0u;
    BounceNumbers u = sampleLightBounceNumbers(id, state.bounce);
    // The BSDF of light's own direction is sampled. What it scatters to the camera and onwards is evaluated by the BSDFs that a path from the
    // camera has there. All in a loop, for one copy of the code.
    const uint kSamples = 0u, kToCamera = 1u, kOnwards = 2u;
    uint left = 1u << kSamples;
    Bsdf sampled;
    BsdfSample next;
    BsdfEval toCamera = BsdfEval(vec3(0.0), 0.0), onwards = toCamera;
    do {
        uint now = uint(findLSB(left));
        left &= left - 1u;
        vec3 wo = now == kSamples ? wi : now == kToCamera ? connection.wo : next.wi, to = wi;
        Bsdf bsdf = bsdfTowards(wo, si, material);
        vec3 local = frameFromWorld(bsdf.frame, wi);
        if (now == kSamples) {
            sampled = bsdf;
            next = sampleUnweighted(bsdf, wo, u.direction, u.lobe, local);
            to = next.wi;
        }
        BsdfEval f = evalInFrame(bsdf, wo, local, dot(to, bsdf.ng));
        if (now == kSamples) {
            next = weightSample(next, f);
            bool scatters = !isFirst && hasNonDelta(bsdf);
            left |= scatters && inPicture ? 1u << kToCamera : 0u;
            left |= scatters && (next.flags & kBsdfDelta) == 0u ? 1u << kOnwards : 0u;
        } else if (now == kToCamera) {
            toCamera = f;
        } else {
            onwards = f;
        }
    } while (left != 0u);
    float pixels = float(render.width) * float(render.height);
    float cameraFactor = adjointFactor(si.ng, wi, connection.wo) * connection.weight;
    vec3 contribution = state.throughput * toCamera.f * cameraFactor * (pixels / float(render.lightPaths));
    vec3 origin = offsetRayOrigin(si, connection.wo);
    vertex.cameraRay = ShadowRay(origin, si.primitive, connection.origin - origin, kNoPrimitive, contribution, 1.0);
    if (hasFeature(kFeatureMedia)) {
        vertex.cameraRay.contribution *= mediaTransmittance(ray.media, si, sampled.medium, vertex.cameraRay);
    }
    vertex.hasSplat = any(notEqual(contribution, vec3(0.0))) && state.bounce + 1u >= render.minPathLength;
    bool specular = (next.flags & kBsdfDelta) != 0u;
    float factor = specular          ? specularFactor(next, wi, si.ng, sampled.frame.z)
                   : next.pdf > 0.0 ? adjointFactor(si.ng, wi, next.wi) / next.pdf
                                    : 0.0;
    vec3 weight = (specular ? next.weight : onwards.f) * factor;
    vec3 throughput = state.throughput * weight;
    float continuation = continuationProbability(throughput, 1.0, state.bounce);
    vertex.ray = spawnRay(si, next.wi);
    vertex.ray.media = mediaOfNextRay(ray.media, si, sampled, next.wi);
    float ratio = 0.0;
    vertex.cameraRatio = 0.0;
    if (render.comparesPaths != 0u) {
        // A camera path comes the other way: it samples the BSDF there, its radiance is scaled where it is refracted, and it ends by roulette
        // about as often.
        float eta2 = next.eta * next.eta;
        vertex.cameraRatio = state.pdf * float(render.lightPaths) / max(toCamera.pdf * cameraFactor * pixels, 1e-30);
        ratio = state.pdf / max(factor * (specular ? 1.0 / (eta2 * eta2) : onwards.pdf), 1e-30);
    }
    vertex.state = PathState(throughput / continuation, ratio, 0.0, 1.0, state.bounce + 1u, state.normal);
    bool ends = state.bounce + 1u >= min(render.maxBounces, render.maxPathLength) || (isFirst && !specular);
    vertex.hasNextRay = !ends && any(notEqual(throughput, vec3(0.0))) && u.roulette < continuation;
    return vertex;
}

#endif
