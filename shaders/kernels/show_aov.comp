// One thread is one slot of the pass. Replaces the radiance of its path by what --view asks for: normals, distances along
// the view axis (0 on a miss), base colours, visits to inner nodes and tests of primitives by the camera ray, or what the guide knows where
// that ray ends.
// Reads the scene, the guide, rays, first hits; nothing has bounced. Writes radiance.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_RAYS
#define READS_FIRST_HITS
#define WRITES_RADIANCE
#include "access/guide.glsl"
#include "access/path_time.glsl"
#include "access/paths.glsl"
#include "access/status.glsl"
#include "access/traverse.glsl"

vec3 countSteps(PathRay ray)
{
    Steps steps = Steps(0u, 0u);
    traceClosest(ray, unrestrictedQuery(), steps);
    return vec3(steps.nodes, steps.primitives, 0.0);
}

const uint kGuideGrid = 8u;

// The guide's mean direction, times the mean of its density over that of all directions: 1 if it knows no direction from another, N if it
// chooses among 1/N of them. 0 where there is no guide. The grid is the same for all rays, so that cells show and no noise.
vec3 describeGuide(Guide guide)
{
    if (!(guide.share > 0.0)) {
        return vec3(0.0);
    }
    vec3 sum = vec3(0.0);
    float density = 0.0;
    for (uint i = 0u; i < kGuideGrid * kGuideGrid; ++i) {
        vec2 u = (vec2(i % kGuideGrid, i / kGuideGrid) + 0.5) / float(kGuideGrid);
        GuideSample guided = sampleGuideOr(guide, true, u, vec3(0.0, 0.0, 1.0));
        sum += guided.w;
        density += guided.pdf;
    }
    float concentration = 4.0 * kPi * density / float(kGuideGrid * kGuideGrid);
    float square = dot(sum, sum);
    return square > 0.0 ? concentration / sqrt(square) * sum : vec3(0.0);
}

vec3 showGuide(uint slot, FirstHit first)
{
    if (first.alpha == 0.0) {
        return vec3(0.0);
    }
    SampleId id = makeSampleId(slot);
    beginPath(id);
    PathRay ray = fetchRay(slot);
    Steps uncounted = Steps(0u, 0u);
    PathHit hit = traceVisible(id, 0u, ray, uncounted).hit;
    return describeGuide(fetchGuide(ray.origin + hit.t * ray.direction, first.normal));
}

vec3 getAov(uint slot)
{
    if (kAov == kAovBvhSteps) {
        beginPath(makeSampleId(slot));
        return countSteps(fetchRay(slot));
    }
    FirstHit first = fetchFirstHit(slot);
    if (kAov == kAovGuide) {
        return showGuide(slot, first);
    }
    if (kAov == kAovDepth) {
        return vec3(first.alpha > 0.0 ? first.depth : 0.0);
    }
    return kAov == kAovAlbedo ? first.albedo : first.normal;
}

void main()
{
    uint slot = interleavedInvocation();
    if (slot < samplesOfPass()) {
        storeRadiance(slot, PathRadiance(getAov(slot), 0.0));
    }
    checkLoopBudget(render.canarySteps);
}
