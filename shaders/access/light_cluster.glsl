// Lights of a cluster that is small from a point: all are about as far away and in the same direction. So one is chosen by its power towards
// the point, without going down the light tree. That is power times the cosine at the light's normal n, of which the sum over axes of
// max(0, towards[i] * n[i]) is an upper bound, at most sqrt(3) times as large. That sum is linear in the lights, for each octant of
// directions: so prefix sums for the two sides of each axis are all that a choice needs.
#ifndef GLIM_ACCESS_LIGHT_CLUSTER
#define GLIM_ACCESS_LIGHT_CLUSTER

#include "parameters.glsl"
#include "scene.glsl"
#include "shared/guide_types.h"

// Squared radius over squared distance below which a cluster is small.
const float kSmallCluster = 0.03;

struct LightChoice {
    uint light;
    float probability;  // 0: none is to be sampled
    uint part;          // of the light tree: the child of its root; or kSightOfInfinite
};

// Some lights, one behind the other in the tree's order, and the direction from them to a point.
struct LightCluster {
    uint begin, end;
    vec3 towards;  // of any length
};

#define isSmallCluster(node, p) \
    (hasFeature(kFeatureLightClusters) && ((node).children & kClusterNode) != 0u && \
     (node).radius * (node).radius < kSmallCluster * dot((node).center - (p), (node).center - (p)))

uvec3 fetchPowersTowards(uint light, vec3 towards)
{
    uvec3 front = fetchLightPowers(render.lightCount, light, 0u), back = fetchLightPowers(render.lightCount, light, 1u);
    return mix(back, front, greaterThan(towards, vec3(0.0)));
}

// By axis, of the lights from `begin` to `end`.
vec3 powersTowards(uint begin, uint end, vec3 towards)
{
    return abs(towards) * vec3(fetchPowersTowards(end, towards) - fetchPowersTowards(begin, towards));
}

float atAxis(vec3 v, uint axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }
uint atAxis(uvec3 v, uint axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }

// The light that u in [0, 1) falls to, by axis and then by power on that side; or `light`, if it is one.
LightChoice chooseInCluster(LightCluster cluster, float u, uint light)
{
    vec3 whole = powersTowards(cluster.begin, cluster.end, cluster.towards);
    float sum = whole.x + whole.y + whole.z;
    if (light == kNoLightIndex) {
        float target = u * sum;
        uint axis = target < whole.x ? 0u : target < whole.x + whole.y ? 1u : 2u;
        float before = axis == 0u ? 0.0 : axis == 1u ? whole.x : whole.x + whole.y;
        float width = atAxis(whole, axis), step = abs(atAxis(cluster.towards, axis));
        uint back = atAxis(cluster.towards, axis) > 0.0 ? 0u : 1u;
        uint first = atAxis(fetchLightPowers(render.lightCount, cluster.begin, back), axis);
        uint wanted = step > 0.0 ? uint(clamp(target - before, 0.0, width) / step) : 0u;
        uint low = cluster.begin, high = cluster.end - 1u;
        do {
            uint middle = (low + high + 1u) / 2u;
            bool above = atAxis(fetchLightPowers(render.lightCount, middle, back), axis) - first <= wanted;
            low = above ? middle : low;
            high = above ? high : middle - 1u;
        } while (low < high);
        light = low;
    }
    vec3 part = powersTowards(light, light + 1u, cluster.towards);
    return LightChoice(light, (part.x + part.y + part.z) / sum, 0u);
}

#endif
