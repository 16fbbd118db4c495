// A film by light groups (shared/pixel_moments.h).
#ifndef GLIM_ACCESS_GROUP_SUMS
#define GLIM_ACCESS_GROUP_SUMS

#include "light_groups.glsl"
#include "shared/pixel_moments.h"

layout(set = 0, binding = kBindGroupSums, scalar) buffer GroupSumsBuffer { vec3 groupSums[]; };

uint placeOfSums(uint at)
{
    return at * sumsOfGroups(render.lightGroups);
}

// Of a finished sample.
void addGroups(uint at, uint slot)
{
    uint sums = placeOfSums(at);
    for (uint group = 0u; group < render.lightGroups; ++group) {
        groupSums[sums + group] += fetchGroupLight(slot, group);
    }
}

// Moves the block, of `count` samples, to the page, which has `before`.
void foldGroups(uint at, uint before, uint count)
{
    if (count == 0u) {
        return;
    }
    uint groups = render.lightGroups, sums = placeOfSums(at), means = sums + groups, pair = means + groups;
    float inBlock = 1.0 / float(count), share = float(count) / float(before + count);
    for (uint g = 0u; g < groups; ++g) {
        groupSums[sums + g] = groupSums[sums + g] * inBlock - groupSums[means + g];
    }
    for (uint g = 0u; g < groups; ++g) {
        vec3 delta = groupSums[sums + g];
        for (uint other = g; other < groups; ++other) {
            groupSums[pair] = foldProducts(groupSums[pair], vec3(0.0), delta, groupSums[sums + other], float(before), share);
            ++pair;
        }
        groupSums[means + g] = foldMean(groupSums[means + g], delta, share);
    }
    for (uint g = 0u; g < groups; ++g) {
        groupSums[sums + g] = vec3(0.0);
    }
}

#endif
