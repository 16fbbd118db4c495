// --clamp-indirect: a biased clamp that reports how much light it removes.
#ifndef GLIM_LIB_CLAMP_INDIRECT
#define GLIM_LIB_CLAMP_INDIRECT

struct ClampedLight {
    vec3 kept;
    float removed;  // mean of the three channels
};

// Scales a contribution to a sample so that no channel exceeds `limit`, if the light has met two surfaces or more. A limit of infinity
// removes nothing and changes no bit.
ClampedLight clampIndirect(vec3 contribution, uint pathLength, float limit)
{
    float largest = max(contribution.r, max(contribution.g, contribution.b));
    if (pathLength < 2u || !(largest > limit)) {
        return ClampedLight(contribution, 0.0);
    }
    vec3 kept = contribution * (limit / largest);
    vec3 gone = contribution - kept;
    return ClampedLight(kept, (gone.r + gone.g + gone.b) * (1.0 / 3.0));
}

#endif
