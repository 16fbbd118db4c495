// Russian roulette.
#ifndef GLIM_LIB_ROULETTE
#define GLIM_LIB_ROULETTE

// Hits before the first roulette: the first bounces carry most of the light.
const uint kRouletteBounce = 2u;

// A path that goes on has this inverse as its least throughput. Of 1 from hit 3 on and 2 to 6 from hits 1 to 5, 3 from hit 2 on has the least
// error per second in Cornell boxes, 1.18 to 1.26 times less than 1 from hit 3 on; 2 to 5 are within 5 % (tests/bench/EXPERIMENTS.md).
const float kRouletteScale = 3.0;

// Of guided paths: what the guide knows may be wrong.
const float kLeastGuidedContinuation = 0.05;

// Probability to continue: min(1, kRouletteScale * largest throughput * etaScale). etaScale undoes refraction's scaling of radiance (Arvo
// and Kirk 1990; etaScale as in pbrt-v4). Never capped below 1: any cap q gives infinite variance once albedo^2 >= q.
float continuationProbability(vec3 throughput, float etaScale, uint bounce)
{
    float largest = max(throughput.r, max(throughput.g, throughput.b)) * etaScale;
    return bounce < kRouletteBounce ? 1.0 : min(1.0, kRouletteScale * largest);
}

#endif
