// The bounce by the course's rules: its roulettes, and no last ray that could only find light that was already sampled.
#ifndef GLIM_ACCESS_COURSE_BOUNCE
#define GLIM_ACCESS_COURSE_BOUNCE

#include "access/course/round.glsl"
#include "access/next_ray.glsl"
#include "lib/course/fixed_roulette.glsl"
#include "lib/roulette.glsl"

// The last ray of a path only collects emission, which does not count where light sampling already covers it.
bool isRedundant(BsdfSample s, uint bounce)
{
    bool sampled = kDirect == kDirectLights || kDirect == kDirectHemisphere;
    return sampled && s.pdf > 0.0 && bounce + 1u == render.maxBounces;
}

float computeContinuation(BsdfSample s, vec3 throughput, float etaScale, uint bounce)
{
    return isRedundant(s, bounce)            ? 0.0
           : kRoulette == kRouletteThroughput ? continuationProbability(throughput, etaScale, bounce)
           : kRoulette == kRouletteFixed      ? fixedContinuation(course.continuation, bounce)
                                              : 1.0;
}

#endif
