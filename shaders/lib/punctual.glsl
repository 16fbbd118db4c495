// Lights without extent.
#ifndef GLIM_LIB_PUNCTUAL
#define GLIM_LIB_PUNCTUAL

// Falloff of a spot towards its rim: the squared linear ramp in the cosine that KHR_lights_punctual recommends, with its
// 0.001 replaced by 1e-4, which only matters for a rim sharper than that.
float spotFalloff(float cosine, float cosInner, float cosOuter)
{
    float ramp = clamp((cosine - cosOuter) / max(1e-4, cosInner - cosOuter), 0.0, 1.0);
    return ramp * ramp;
}

#endif
