// The state of paths between kernels. A kernel says what it does with a buffer before including this: READS_x, WRITES_x or
// UPDATES_x (both) for x in RAYS, HITS, ... so that synchronization validation can see hazards.
#ifndef GLIM_ACCESS_PATHS
#define GLIM_ACCESS_PATHS

#include "pass.glsl"
#include "queues.glsl"
#include "shared/pixel_moments.h"

#define DECLARE(qualifier, number, type, name) \
    layout(set = 0, binding = number, scalar) qualifier buffer name##Buffer { type name[]; }

// Paths are read as texels: on CPUs, loading one word of a storage buffer costs as much as loading the four of a texel. A kernel that
// updates a buffer stores values that depend on those it has read, so the reads come first
// (KernelRulesTest).
#define TEXELS(number, name) layout(set = 0, binding = number + kTexelsOf) uniform usamplerBuffer name
// They are stored as texels too: GPUs store four words at once if the type says that they lie together.
#define WORDS(number, name) \
    layout(set = 0, binding = number, scalar) writeonly buffer name##Buffer { uvec4 name[]; }

#if defined(READS_RAYS) || defined(UPDATES_RAYS)
TEXELS(kBindRays, rayTexels);

PathRay fetchRay(uint slot)
{
    uvec4 a = texelFetch(rayTexels, int(2u * slot));
    uvec4 b = texelFetch(rayTexels, int(2u * slot + 1u));
    return PathRay(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w);
}
#endif
#if defined(WRITES_RAYS) || defined(UPDATES_RAYS)
WORDS(kBindRays, rayWords);

void storeRay(uint slot, PathRay ray)
{
    rayWords[2u * slot] = uvec4(floatBitsToUint(ray.origin), ray.source);
    rayWords[2u * slot + 1u] = uvec4(floatBitsToUint(ray.direction), ray.media);
}
#endif

#if defined(READS_HITS) || defined(UPDATES_HITS)
TEXELS(kBindHits, hitTexels);

PathHit fetchHit(uint slot)
{
    uvec4 a = texelFetch(hitTexels, int(slot));
    return PathHit(a.x, uintBitsToFloat(a.y), uintBitsToFloat(a.zw));
}
#endif
#if defined(WRITES_HITS) || defined(UPDATES_HITS)
WORDS(kBindHits, hitWords);

void storeHit(uint slot, PathHit hit)
{
    hitWords[slot] = uvec4(hit.primitiveRef, floatBitsToUint(hit.t), floatBitsToUint(hit.barycentric));
}
#endif

#if defined(READS_STATES) || defined(UPDATES_STATES)
TEXELS(kBindStates, stateTexels);

PathState fetchState(uint slot)
{
    uvec4 a = texelFetch(stateTexels, int(2u * slot));
    uvec4 b = texelFetch(stateTexels, int(2u * slot + 1u));
    return PathState(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), uintBitsToFloat(b.x), uintBitsToFloat(b.y), b.z, b.w);
}
#endif
#if defined(WRITES_STATES) || defined(UPDATES_STATES)
WORDS(kBindStates, stateWords);

void storeState(uint slot, PathState state)
{
    stateWords[2u * slot] = uvec4(floatBitsToUint(state.throughput), floatBitsToUint(state.pdf));
    stateWords[2u * slot + 1u] = uvec4(floatBitsToUint(state.cosine), floatBitsToUint(state.etaScale), state.bounce, state.normal);
}
#endif

#if defined(READS_RADIANCE) || defined(UPDATES_RADIANCE)
TEXELS(kBindRadiance, radianceTexels);

PathRadiance fetchRadiance(uint slot)
{
    uvec4 a = texelFetch(radianceTexels, int(slot));
    return PathRadiance(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w));
}
#endif
#if defined(WRITES_RADIANCE) || defined(UPDATES_RADIANCE)
WORDS(kBindRadiance, radianceWords);

void storeRadiance(uint slot, PathRadiance path)
{
    radianceWords[slot] = uvec4(floatBitsToUint(path.radiance), floatBitsToUint(path.clamped));
}
#endif

#if defined(READS_FIRST_HITS)
TEXELS(kBindFirstHits, firstHitTexels);

FirstHit fetchFirstHit(uint slot)
{
    uvec4 a = texelFetch(firstHitTexels, int(2u * slot));
    uvec4 b = texelFetch(firstHitTexels, int(2u * slot + 1u));
    return FirstHit(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), uintBitsToFloat(b.xyz), uintBitsToFloat(b.w));
}
#elif defined(WRITES_FIRST_HITS)
WORDS(kBindFirstHits, firstHitWords);

void storeFirstHit(uint slot, FirstHit first)
{
    firstHitWords[2u * slot] = uvec4(floatBitsToUint(first.albedo), floatBitsToUint(first.alpha));
    firstHitWords[2u * slot + 1u] = uvec4(floatBitsToUint(first.normal), floatBitsToUint(first.depth));
}
#endif

#if defined(READS_SHADOW_RAYS) || defined(UPDATES_SHADOW_RAYS)
TEXELS(kBindShadowRays, shadowRayTexels);

ShadowRay fetchShadowRay(uint slot)
{
    uvec4 a = texelFetch(shadowRayTexels, int(3u * slot));
    uvec4 b = texelFetch(shadowRayTexels, int(3u * slot + 1u));
    uvec4 c = texelFetch(shadowRayTexels, int(3u * slot + 2u));
    return ShadowRay(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), uintBitsToFloat(c.w));
}
#endif
#if defined(WRITES_SHADOW_RAYS) || defined(UPDATES_SHADOW_RAYS)
WORDS(kBindShadowRays, shadowRayWords);

void storeShadowRay(uint slot, ShadowRay ray)
{
    shadowRayWords[3u * slot] = uvec4(floatBitsToUint(ray.origin), ray.source);
    shadowRayWords[3u * slot + 1u] = uvec4(floatBitsToUint(ray.direction), ray.target);
    shadowRayWords[3u * slot + 2u] = uvec4(floatBitsToUint(ray.contribution), floatBitsToUint(ray.tMax));
}
#endif

#if defined(UPDATES_FILM)
DECLARE(, kBindBlocks, BlockSums, filmBlocks);
DECLARE(, kBindPages, PixelMoments, filmPages);
DECLARE(, kBindBrightest, BrightestSample, filmBrightest);
DECLARE(, kBindCatchers, CatcherSums, filmCatchers);
#endif

#if defined(UPDATES_LUMINANCE)
DECLARE(, kBindLuminance, LuminanceMoments, filmLuminance);
#elif defined(READS_LUMINANCE)
DECLARE(readonly, kBindLuminance, LuminanceMoments, filmLuminance);
#endif

#endif
