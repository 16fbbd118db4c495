// The tables of directional albedos (host/flatten/albedo_table.hpp makes them).
#ifndef GLIM_ACCESS_ALBEDO_TABLE
#define GLIM_ACCESS_ALBEDO_TABLE

#include "features.glsl"
#include "lib/bsdf/ggx.glsl"
#include "lib/fresnel.glsl"
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

// The two steps of an axis between which a number lies.
struct AlbedoCell {
    int first;
    float weight;  // of the other one
};

// x in [0, 1], but for rounding.
AlbedoCell albedoCell(float x, uint count)
{
    float y = min(x, 1.0) * float(count - 1u);
    int first = min(int(y), int(count) - 2);
    return AlbedoCell(first, y - float(first));
}

vec4 mixTexels(int at, int step, float weight)
{
    vec4 lower = uintBitsToFloat(texelFetch(sceneAlbedos, at));
    vec4 upper = uintBitsToFloat(texelFetch(sceneAlbedos, at + step));
    return lower + (upper - lower) * weight;
}

// a and b of the lobe of two widths, alpha.x >= alpha.y >= kMinAlpha, at a direction on the upper side. Linear in four numbers: a + b is
// off by less than 4e-3, b by 4e-2.
vec2 fetchAlbedo(vec2 alpha, vec3 w)
{
    float sine = length(w.xy), stretched = stretchedLength(w, alpha);
    float along = sine > 0.0 ? length(alpha * w.xy) / sine : alpha.x;
    float seen = sqrt(w.z / stretched), size = sqrt(alpha.x);
    AlbedoCell cosine = albedoCell(seen * sqrt(seen), kAnisotropicCosines);
    AlbedoCell narrow = albedoCell(alpha.y / along, kAnisotropicRatios);
    AlbedoCell wide = albedoCell(along / alpha.x, kAnisotropicRatios);
    AlbedoCell large = albedoCell(size * sqrt(size), kAnisotropicAlphas);
    const int kNarrow = int(kAnisotropicCosines), kWide = kNarrow * int(kAnisotropicRatios), kLarge = kWide * int(kAnisotropicRatios);
    int at = int(kFirstAnisotropicAlbedo) + cosine.first + narrow.first * kNarrow + wide.first * kWide + large.first * kLarge;
    vec4 a = mixTexels(at, kNarrow, narrow.weight), b = mixTexels(at + kWide, kNarrow, narrow.weight);
    vec4 c = mixTexels(at + kLarge, kNarrow, narrow.weight), d = mixTexels(at + kLarge + kWide, kNarrow, narrow.weight);
    vec4 lower = a + (b - a) * wide.weight, upper = c + (d - c) * wide.weight;
    vec4 both = lower + (upper - lower) * large.weight;
    vec2 entry = both.xy + (both.zw - both.xy) * cosine.weight;
    float schlick = schlickWeight(min(entry.y * stretched, 1.0));
    return vec2(entry.x * (1.0 - schlick), entry.x * schlick);
}

// The averages of a and b for a lobe of two widths.
vec2 fetchAverageAlbedo(vec2 alpha)
{
    AlbedoCell ratio = albedoCell(alpha.y / alpha.x, kAnisotropicAverageRatios);
    AlbedoCell size = albedoCell(sqrt(alpha.x), kAnisotropicAverageAlphas);
    const int kSize = int(kAnisotropicAverageRatios);
    int at = int(kFirstAnisotropicAlbedo + kAnisotropicAlbedos) + ratio.first + size.first * kSize;
    vec4 both = mixTexels(at, kSize, size.weight);
    vec2 entry = both.xy + (both.zw - both.xy) * ratio.weight;
    return vec2(1.0 - entry.x * alpha.x - entry.y, entry.y);
}

// Rows of the table of interfaces that refract (scene_types.h), alpha in [kMinAlpha, 1]: between which four numbers lie.
struct GlassRows {
    int first;
    float alpha, index;  // weights of the others
};

GlassRows glassRows(float alpha, float eta)
{
    float r = (eta - 1.0) / (eta + 1.0);
    float root = max(sqrt(sqrt(abs(r))) - kMinGlassRoot, 0.0) * (1.0 / (kMaxGlassRoot - kMinGlassRoot));
    AlbedoCell index = albedoCell(root, r > 0.0 ? kGlassDenser : kGlassThinner), row = albedoCell(sqrt(alpha), kGlassAlphas);
    return GlassRows(row.first + (index.first + (r > 0.0 ? 0 : int(kGlassDenser))) * int(kGlassAlphas), row.weight, index.weight);
}

// t, p and q at a cosine. Trilinear.
vec3 fetchGlassAlbedo(float alpha, float eta, float cosine)
{
    GlassRows rows = glassRows(alpha, eta);
    AlbedoCell column = albedoCell(sqrt(sqrt(cosine)), kGlassCosines);
    const int kRow = int(kGlassCosines), kIndex = kRow * int(kGlassAlphas);
    int at = int(kFirstGlassAlbedo) + column.first + rows.first * kRow;
    vec4 a = mixTexels(at, 1, column.weight), b = mixTexels(at + kRow, 1, column.weight);
    vec4 c = mixTexels(at + kIndex, 1, column.weight), d = mixTexels(at + kIndex + kRow, 1, column.weight);
    vec4 lower = a + (b - a) * rows.alpha, upper = c + (d - c) * rows.alpha;
    return (lower + (upper - lower) * rows.index).xyz;
}

// Their averages, and for eta above 1 the share for glassReflects.
vec4 fetchAverageGlassAlbedo(float alpha, float eta)
{
    GlassRows rows = glassRows(alpha, eta);
    int at = int(kFirstGlassAlbedo + kGlassAlbedos) + rows.first;
    vec4 lower = mixTexels(at, 1, rows.alpha), upper = mixTexels(at + int(kGlassAlphas), 1, rows.alpha);
    return lower + (upper - lower) * rows.index;
}

#endif
