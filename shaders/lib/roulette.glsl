// Russian roulette.
#ifndef GLIM_LIB_ROULETTE
#define GLIM_LIB_ROULETTE

// Hits before the first roulette: the first bounces carry most of the light.
const uint kRouletteBounce = 3u;

// Probability to go on: min(1, largest throughput), freed of what refraction compresses (Arvo and Kirk 1990; the eta scale as
// in pbrt-v4). Never capped below 1: any cap q gives infinite variance once albedo^2 >= q.
float survivalProbability(vec3 throughput, float etaScale, uint bounce)
{
    float largest = max(throughput.r, max(throughput.g, throughput.b)) * etaScale;
    return bounce < kRouletteBounce ? 1.0 : min(1.0, largest);
}

// The course's rule: after one guaranteed indirect bounce go on with a fixed probability q. In a closed room of albedo a its
// variance is infinite where a^2 >= q, for q = .7 above a = .837.
float survivalFixed(float q, uint bounce)
{
    return bounce == 0u ? 1.0 : q;
}

#endif
