// The falloffs of point and spot lights.
#ifndef GLIM_LIB_PUNCTUAL
#define GLIM_LIB_PUNCTUAL

// 1 - cos of the angle between two unit vectors, to float's rounding however small it is.
float versine(vec3 a, vec3 b)
{
    vec3 d = a - b;
    return 0.5 * dot(d, d);
}

// Falloff of a spot towards its rim, by versines: the squared linear ramp in the cosine that KHR_lights_punctual recommends, but without its
// least width of .001, which darkens spots narrower than 2.6 degrees.
float spotFalloff(float angle, float inner, float outer)
{
    float ramp = clamp((outer - angle) / (outer - inner), 0.0, 1.0);
    return angle >= outer ? 0.0 : angle <= inner ? 1.0 : ramp * ramp;
}

// What a light's range leaves of it at a squared distance: the window that KHR_lights_punctual recommends. range 0: no window.
float rangeFalloff(float distance2, float range)
{
    float share = distance2 / (range * range);
    return range > 0.0 ? clamp(1.0 - share * share, 0.0, 1.0) : 1.0;
}

#endif
