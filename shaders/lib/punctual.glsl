// Lights without extent.
#ifndef GLIM_LIB_PUNCTUAL
#define GLIM_LIB_PUNCTUAL

// Falloff of a spot towards its rim: the squared linear ramp in the cosine that KHR_lights_punctual recommends, but without its least width
// of .001, which darkens spots narrower than 2.6 degrees.
float spotFalloff(float cosine, float cosInner, float cosOuter)
{
    float ramp = clamp((cosine - cosOuter) / (cosInner - cosOuter), 0.0, 1.0);
    return cosine <= cosOuter ? 0.0 : cosine >= cosInner ? 1.0 : ramp * ramp;
}

#endif
