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

// What a light's range leaves of it at a squared distance: the window that KHR_lights_punctual recommends. range 0: no window.
float rangeFalloff(float distance2, float range)
{
    float share = distance2 / (range * range);
    return range > 0.0 ? clamp(1.0 - share * share, 0.0, 1.0) : 1.0;
}

#endif
