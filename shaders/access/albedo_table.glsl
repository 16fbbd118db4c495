// The table of the GGX lobe's directional albedos (host/flatten/albedo_table.hpp makes it).
#ifndef GLIM_ACCESS_ALBEDO_TABLE
#define GLIM_ACCESS_ALBEDO_TABLE

#include "features.glsl"
#include "shared/scene_types.h"

layout(set = 0, binding = kBindAlbedos) uniform usamplerBuffer sceneAlbedos;

// The two rows between which a roughness lies.
struct AlbedoRow {
    int row;       // the lower one
    float weight;  // of the upper one, in [0, 1]
};

// alpha in [0, 1].
AlbedoRow albedoRow(float alpha)
{
    float y = sqrt(sqrt(alpha)) * float(kAlbedoSize - 1u);
    int row = min(int(y), int(kAlbedoSize) - 2);
    return AlbedoRow(row, y - float(row));
}

// a and b of lib/bsdf/multiple_scattering.glsl at a cosine in [0, 1]. Bilinear: off by 1.5e-3 at most for cosines from .005 on.
vec2 fetchAlbedo(AlbedoRow row, float cosine)
{
    float x = sqrt(sqrt(min(cosine, 1.0))) * float(kAlbedoSize - 1u);
    int column = min(int(x), int(kAlbedoSize) - 2);
    float t = x - float(column);
    int at = row.row * int(kAlbedoSize) + column;
    vec4 lower = uintBitsToFloat(texelFetch(sceneAlbedos, at));
    vec4 upper = uintBitsToFloat(texelFetch(sceneAlbedos, at + int(kAlbedoSize)));
    vec4 both = lower + (upper - lower) * row.weight;
    return both.xy + (both.zw - both.xy) * t;
}

// a and b averaged over the hemisphere, weighted by the cosine.
vec2 fetchAverageAlbedo(AlbedoRow row)
{
    vec4 both = uintBitsToFloat(texelFetch(sceneAlbedos, int(kAlbedoSize * kAlbedoSize) + row.row));
    return both.xy + (both.zw - both.xy) * row.weight;
}

// The albedo of the sheen lobe for the colour white, which may exceed 1.
float fetchSheenAlbedo(AlbedoRow row, float cosine)
{
    float x = sqrt(sqrt(min(cosine, 1.0))) * float(kAlbedoSize - 1u);
    int column = min(int(x), int(kAlbedoSize) - 2);
    int at = int(kAlbedoSize * (kAlbedoSize + 1u)) + row.row * int(kAlbedoSize) + column;
    vec4 corners = uintBitsToFloat(texelFetch(sceneAlbedos, at));
    vec2 both = corners.xz + (corners.yw - corners.xz) * (x - float(column));
    return both.x + (both.y - both.x) * row.weight;
}

#endif
