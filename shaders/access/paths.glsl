// The state of paths between kernels. A kernel says what it does with a buffer before including this: READS_x, WRITES_x or
// UPDATES_x (both) for x in RAYS, HITS, ... so that synchronization validation can see hazards.
#ifndef GLIM_ACCESS_PATHS
#define GLIM_ACCESS_PATHS

#include "pass.glsl"
#include "shared/pixel_moments.h"

#define DECLARE(qualifier, number, type, name) \
    layout(set = 0, binding = number, scalar) qualifier buffer name##Buffer { type name[]; }

// Paths are read as texels: on CPUs, loading one word of a storage buffer costs as much as loading the four of a texel. A kernel that
// updates a buffer stores values that depend on those it has read, so the reads come first
// (KernelRulesTest).
#define TEXELS(number, name) layout(set = 0, binding = number + kTexelsOf) uniform usamplerBuffer name

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
DECLARE(writeonly, kBindRays, PathRay, pathRays);
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
DECLARE(writeonly, kBindHits, PathHit, pathHits);
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
DECLARE(writeonly, kBindStates, PathState, pathStates);
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
DECLARE(writeonly, kBindRadiance, PathRadiance, pathRadiance);
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
DECLARE(writeonly, kBindFirstHits, FirstHit, pathFirstHits);
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
DECLARE(writeonly, kBindShadowRays, ShadowRay, pathShadowRays);
#endif

#if defined(READS_ACTIVE_QUEUE)
DECLARE(readonly, kBindActiveQueue, uint, activeQueue);
#endif

#if defined(WRITES_NEXT_QUEUE)
DECLARE(writeonly, kBindNextQueue, uint, nextQueue);
#endif

#if defined(READS_SHADOW_QUEUE)
DECLARE(readonly, kBindShadowQueue, uint, shadowQueue);
#elif defined(WRITES_SHADOW_QUEUE)
DECLARE(writeonly, kBindShadowQueue, uint, shadowQueue);
#endif

#if defined(READS_QUEUE_SIZES)
layout(set = 0, binding = kBindQueueSizes, scalar) readonly buffer QueueSizesBuffer { QueueSizes queueSizes; };
#elif defined(WRITES_QUEUE_SIZES)
layout(set = 0, binding = kBindQueueSizes, scalar) writeonly buffer QueueSizesBuffer { QueueSizes queueSizes; };
#endif

#if defined(UPDATES_QUEUE_TAILS)
layout(set = 0, binding = kBindQueueTails, scalar) buffer QueueTailsBuffer { QueueTails queueTails; };
#endif

#if defined(UPDATES_FILM)
DECLARE(, kBindBlocks, BlockSums, filmBlocks);
DECLARE(, kBindPages, PixelMoments, filmPages);
DECLARE(, kBindBrightest, BrightestSample, filmBrightest);
#endif

#if defined(UPDATES_LUMINANCE)
DECLARE(, kBindLuminance, LuminanceMoments, filmLuminance);
#elif defined(READS_LUMINANCE)
DECLARE(readonly, kBindLuminance, LuminanceMoments, filmLuminance);
#endif

#if defined(UPDATES_RAY_COUNTS)
layout(set = 0, binding = kBindRayCounts, scalar) buffer RayCountsBuffer { RayCounts rayCounts; };

// Called by many threads at once.
void countRays(uint closest, uint shadow)
{
    uint before = atomicAdd(rayCounts.closest.x, closest);
    if (before + closest < before) {
        atomicAdd(rayCounts.closest.y, 1u);
    }
    before = atomicAdd(rayCounts.shadow.x, shadow);
    if (before + shadow < before) {
        atomicAdd(rayCounts.shadow.y, 1u);
    }
}
#endif

#endif
