// Light by groups of lights: beside a path's radiance that of each group. They add up to it. A path has a word for the group of its shadow
// ray, and then RGB of each group.
#ifndef GLIM_ACCESS_LIGHT_GROUPS
#define GLIM_ACCESS_LIGHT_GROUPS

#include "features.glsl"
#include "parameters.glsl"

#if defined(READS_GROUP_LIGHT)
#define GROUP_LIGHT readonly
#elif defined(WRITES_GROUP_LIGHT)
#define GROUP_LIGHT writeonly
#else
#define GROUP_LIGHT
#endif
layout(set = 0, binding = kBindGroupLight, scalar) GROUP_LIGHT buffer GroupLightBuffer { uint groupWords[]; };

uint placeOfGroups(uint slot)
{
    return slot * (1u + 3u * render.lightGroups);
}

uint placeOfGroup(uint slot, uint group)
{
    return placeOfGroups(slot) + 1u + 3u * group;
}

#if !defined(WRITES_GROUP_LIGHT)
vec3 fetchGroupLight(uint slot, uint group)
{
    uint at = placeOfGroup(slot, group);
    return uintBitsToFloat(uvec3(groupWords[at], groupWords[at + 1u], groupWords[at + 2u]));
}

uint fetchShadowGroup(uint slot)
{
    return groupWords[placeOfGroups(slot)];
}
#endif

#if !defined(READS_GROUP_LIGHT)
void storeGroupLight(uint slot, uint group, vec3 light)
{
    uint at = placeOfGroup(slot, group);
    groupWords[at] = floatBitsToUint(light.r);
    groupWords[at + 1u] = floatBitsToUint(light.g);
    groupWords[at + 2u] = floatBitsToUint(light.b);
}

void storeShadowGroup(uint slot, uint group)
{
    groupWords[placeOfGroups(slot)] = group;
}

void clearGroupLight(uint slot)
{
    for (uint group = 0u; group < render.lightGroups; ++group) {
        storeGroupLight(slot, group, vec3(0.0));
    }
}
#endif

#endif
