// Textures, filtered by hand: the samplers of drivers weigh with 8 bits and decode sRGB with errors of 1e-3, and Mesa 22.3 cannot choose
// among images.
#ifndef GLIM_ACCESS_TEXTURE
#define GLIM_ACCESS_TEXTURE

#include "lib/texture_filter.glsl"
#include "scene.glsl"

#define TEXEL_VIEW(number) layout(set = 0, binding = kBindTexels + number) uniform usamplerBuffer sceneTexels##number
TEXEL_VIEW(0);
TEXEL_VIEW(1);
TEXEL_VIEW(2);
TEXEL_VIEW(3);
TEXEL_VIEW(4);
TEXEL_VIEW(5);
TEXEL_VIEW(6);
TEXEL_VIEW(7);

// Four bytes. The views have names instead of an index, since Mesa 22.3 cannot choose one by a variable.
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

TextureData fetchTexture(uint texture_)
{
    int at = int(texture_);
    uvec4 a = texelFetch(sceneMaterials, at);
    TextureData data = TextureData(a.x, a.y, a.z, a.w, vec3(1.0, 0.0, 0.0), 0u, vec3(0.0, 1.0, 0.0), 0u);
    if (hasFeature(kFeatureTextureTransforms) && (data.flags & kTransformed) != 0u) {
        data.rowU = floatsOf(texelFetch(sceneMaterials, at + 1));
        data.rowV = floatsOf(texelFetch(sceneMaterials, at + 2));
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
        value = vec4(value.xz * 256.0 + value.yw, more.xz * 256.0 + more.yw) / 257.0;
    }
    value /= 255.0;
    return (data.flags & kSrgb) != 0u ? vec4(linearFromSrgb(value.rgb), value.a) : value;
}

vec4 sampleBilinear(TextureData data, vec2 at)
{
    TexelPair x = bilinearTexels(at.x, data.size & 0xffffu, data.flags >> kWrapS & 3u);
    TexelPair y = bilinearTexels(at.y, data.size >> 16u, data.flags >> kWrapT & 3u);
    vec4 upper = mix(decodedTexel(data, x.first, y.first), decodedTexel(data, x.second, y.first), x.weight);
    vec4 lower = mix(decodedTexel(data, x.first, y.second), decodedTexel(data, x.second, y.second), x.weight);
    return mix(upper, lower, y.weight);
}

// `uv`: the texture coordinates of set 0 and set 1. White if there is no texture.
vec4 sampleTexture(uint texture_, vec4 uv)
{
    vec4 value = vec4(1.0);
    if (hasFeature(kFeatureTextures) && texture_ != 0u) {
        TextureData data = fetchTexture(texture_);
        vec2 at = (data.flags & kSecondUv) != 0u ? uv.zw : uv.xy;
        at = vec2(dot(data.rowU.xy, at) + data.rowU.z, dot(data.rowV.xy, at) + data.rowV.z);
        if ((data.flags & kNearest) != 0u) {
            value = decodedTexel(data, nearestTexel(at.x, data.size & 0xffffu, data.flags >> kWrapS & 3u),
                                 nearestTexel(at.y, data.size >> 16u, data.flags >> kWrapT & 3u));
        } else {
            value = sampleBilinear(data, at);
        }
    }
    return value;
}

#endif
