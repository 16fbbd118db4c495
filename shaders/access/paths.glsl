// The state of paths between kernels. A kernel says what it does with a buffer before including this: READS_x, WRITES_x or
// UPDATES_x (both) for x in RAYS, HITS, ... so that synchronization validation can see hazards.
#ifndef GLIM_ACCESS_PATHS
#define GLIM_ACCESS_PATHS

#include "pass.glsl"
#include "shared/pixel_moments.h"

#define DECLARE(qualifier, number, type, name) \
    layout(set = 0, binding = number, scalar) qualifier buffer name##Buffer { type name[]; }

#if defined(READS_RAYS)
DECLARE(readonly, kBindRays, PathRay, pathRays);
#elif defined(UPDATES_RAYS)
DECLARE(, kBindRays, PathRay, pathRays);
#elif defined(WRITES_RAYS)
DECLARE(writeonly, kBindRays, PathRay, pathRays);
#endif

#if defined(READS_HITS)
DECLARE(readonly, kBindHits, PathHit, pathHits);
#elif defined(UPDATES_HITS)
DECLARE(, kBindHits, PathHit, pathHits);
#endif

#if defined(READS_STATES)
DECLARE(readonly, kBindStates, PathState, pathStates);
#elif defined(WRITES_STATES)
DECLARE(writeonly, kBindStates, PathState, pathStates);
#elif defined(UPDATES_STATES)
DECLARE(, kBindStates, PathState, pathStates);
#endif

#if defined(READS_RADIANCE)
DECLARE(readonly, kBindRadiance, PathRadiance, pathRadiance);
#elif defined(WRITES_RADIANCE)
DECLARE(writeonly, kBindRadiance, PathRadiance, pathRadiance);
#elif defined(UPDATES_RADIANCE)
DECLARE(, kBindRadiance, PathRadiance, pathRadiance);
#endif

#if defined(READS_FIRST_HITS)
DECLARE(readonly, kBindFirstHits, FirstHit, pathFirstHits);
#elif defined(WRITES_FIRST_HITS)
DECLARE(writeonly, kBindFirstHits, FirstHit, pathFirstHits);
#endif

#if defined(READS_SHADOW_RAYS)
DECLARE(readonly, kBindShadowRays, ShadowRay, pathShadowRays);
#elif defined(WRITES_SHADOW_RAYS)
DECLARE(writeonly, kBindShadowRays, ShadowRay, pathShadowRays);
#elif defined(UPDATES_SHADOW_RAYS)
DECLARE(, kBindShadowRays, ShadowRay, pathShadowRays);
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
DECLARE(, kBindLuminance, LuminanceMoments, filmLuminance);
DECLARE(, kBindBrightest, BrightestSample, filmBrightest);
#elif defined(READS_LUMINANCE)
DECLARE(readonly, kBindLuminance, LuminanceMoments, filmLuminance);
#endif

#if defined(UPDATES_RAY_COUNTS)
layout(set = 0, binding = kBindRayCounts, scalar) buffer RayCountsBuffer { RayCounts rayCounts; };
#endif

#endif
