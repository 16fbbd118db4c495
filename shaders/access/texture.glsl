// Textures, filtered by hand: the samplers of drivers weigh with 8 bits and decode sRGB with errors of 1e-3, and some cannot choose among
// images (driver_bugs.md).
#ifndef GLIM_ACCESS_TEXTURE
#define GLIM_ACCESS_TEXTURE

#include "lib/texture_filter.glsl"
#include "scene.glsl"
#include "shared/texture_slots.h"

#define TEXEL_VIEW(number) layout(set = 0, binding = kBindTexels + number) uniform usamplerBuffer sceneTexels##number
TEXEL_VIEW(0);
TEXEL_VIEW(1);
TEXEL_VIEW(2);
TEXEL_VIEW(3);
TEXEL_VIEW(4);
TEXEL_VIEW(5);
TEXEL_VIEW(6);
TEXEL_VIEW(7);

// Four bytes. The views have names instead of an index, since some drivers cannot choose one by a variable (driver_bugs.md).
uvec4 fetchTexel(uint texel)
{
    uint view = kTexelViews > 1u ? texel >> kTexelViewBits : 0u;
    int at = int(texel & ((1u << kTexelViewBits) - 1u));
    if (view == 0u) {
        return texelFetch(sceneTexels0, at);
    }
#define FETCH_FROM(number) \
    if (kTexelViews > uint(number) && view == uint(number)) return texelFetch(sceneTexels##number, at)
    FETCH_FROM(1);
    FETCH_FROM(2);
    FETCH_FROM(3);
    FETCH_FROM(4);
    FETCH_FROM(5);
    FETCH_FROM(6);
    FETCH_FROM(7);
    return uvec4(0u);
}

TextureData fetchTexture(uint textureTexel)
{
    int at = int(textureTexel);
    uvec4 a = texelFetch(sceneMaterials, at);
    TextureData data = TextureData(a.x, a.y, a.z, a.w, vec3(1.0, 0.0, 0.0), 0u, vec3(0.0, 1.0, 0.0), 0u);
    if (hasFeature(kFeatureTextureTransforms) && (data.flags & kTransformed) != 0u) {
        data.rowU = toFloats(texelFetch(sceneMaterials, at + 1));
        data.rowV = toFloats(texelFetch(sceneMaterials, at + 2));
    }
    return data;
}

// The texel in column x of row y, linear, in [0, 1].
vec4 decodedTexel(TextureData data, uint x, uint y)
{
    uint texel = y * (data.size & 0xffffu) + x;
    bool wide = hasFeature(kFeatureWideTextures) && (data.flags & kWide) != 0u;
    vec4 value = vec4(fetchTexel(data.firstTexel + (wide ? 2u * texel : texel)));
    if (wide) {
        vec4 more = vec4(fetchTexel(data.firstTexel + 2u * texel + 1u));
        value = vec4(value.xz * 256.0 + value.yw, more.xz * 256.0 + more.yw);
    }
    value *= wide ? 1.0 / 65535.0 : 1.0 / 255.0;  // the largest one becomes 1
    return (data.flags & kSrgb) != 0u ? vec4(linearFromSrgb(value.rgb), value.a) : value;
}

// `uv`: the texture coordinates of set 0 and set 1. White if there is no texture. The loop over texels keeps kernels small: drivers inline
// every call.
vec4 sampleTexture(uint textureTexel, vec4 uv)
{
    if (!hasFeature(kFeatureTextures) || textureTexel == 0u) {
        return vec4(1.0);
    }
    TextureData data = fetchTexture(textureTexel);
    uvec2 size = uvec2(data.size & 0xffffu, data.size >> 16u), wrap = uvec2(data.flags >> kWrapS & 3u, data.flags >> kWrapT & 3u);
    vec2 at = (data.flags & kSecondUv) != 0u ? uv.zw : uv.xy;
    at = vec2(dot(data.rowU.xy, at) + data.rowU.z, dot(data.rowV.xy, at) + data.rowV.z);
    bool nearest = (data.flags & kNearest) != 0u;
    TexelPair x = bilinearTexels(at.x, size.x, wrap.x), y = bilinearTexels(at.y, size.y, wrap.y);
    if (nearest) {
        x = TexelPair(nearestTexel(at.x, size.x, wrap.x), 0u, 0.0);
        y = TexelPair(nearestTexel(at.y, size.y, wrap.y), 0u, 0.0);
    }
    vec4 value = vec4(0.0);
    uint texel = 0u, count = nearest ? 1u : 4u;
    do {
        bool right = (texel & 1u) != 0u, lower = (texel & 2u) != 0u;
        float weight = (right ? x.weight : 1.0 - x.weight) * (lower ? y.weight : 1.0 - y.weight);
        value += weight * decodedTexel(data, right ? x.second : x.first, lower ? y.second : y.first);
        ++texel;
    } while (texel < count);
    return value;
}

bool hasTexture(PrincipledData p, uint slot)
{
    return (p.textures & 1u << slot) != 0u;
}

// The texture in a slot of the material, or 0.
uint textureIn(PrincipledData p, uint slot)
{
    uint before = bitCount(p.textures & (1u << slot) - 1u);
    return hasTexture(p, slot) ? p.firstTexture + kTextureTexels * before : 0u;
}

struct ThreeTexels {
    vec4 x, y, z;
};

// Three textures at once, in a loop for one copy of the code.
ThreeTexels sampleTextures(uvec3 textures, vec4 uv)
{
    ThreeTexels texels = ThreeTexels(vec4(1.0), vec4(1.0), vec4(1.0));
    uint i = 0u, count = textures.z != 0u ? 3u : textures.y != 0u ? 2u : 1u;
    do {
        vec4 texel = sampleTexture(i == 0u ? textures.x : i == 1u ? textures.y : textures.z, uv);
        texels.x = i == 0u ? texel : texels.x;
        texels.y = i == 1u ? texel : texels.y;
        texels.z = i == 2u ? texel : texels.z;
        ++i;
    } while (i < count);
    return texels;
}

#endif
