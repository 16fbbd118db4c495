// Russian roulette.
#ifndef GLIM_LIB_ROULETTE
#define GLIM_LIB_ROULETTE

// Hits before the first roulette: the first bounces carry most of the light.
const uint kRouletteBounce = 3u;

// Probability to continue: min(1, largest throughput * etaScale). etaScale undoes refraction's scaling of radiance (Arvo and Kirk 1990;
// etaScale as in pbrt-v4). Never capped below 1: any cap q gives infinite variance once albedo^2 >= q.
float continuationProbability(vec3 throughput, float etaScale, uint bounce)
{
    float largest = max(throughput.r, max(throughput.g, throughput.b)) * etaScale;
    return bounce < kRouletteBounce ? 1.0 : min(1.0, largest);
}

#endif
