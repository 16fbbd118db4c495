// Ray against sphere.
#ifndef GLIM_LIB_INTERSECT_SPHERE
#define GLIM_LIB_INTERSECT_SPHERE

// The smallest root in (0, tmax], or -1. The discriminant and the roots as in Haines, Gunther, Akenine-Moller, "Precision
// Improvements for Ray/Sphere Intersection" (Ray Tracing Gems, ch. 7), with c = (|f|-r)(|f|+r), which keeps its digits for a
// ground sphere of 1e5 seen from 1 above. `onSphere`: the ray starts on this sphere, so one root is the start: only the far
// side, met from within, remains.
float intersectSphere(vec3 origin, vec3 direction, vec3 center, float radius, float tmax, bool onSphere)
{
    vec3 f = origin - center;
    float a = dot(direction, direction);
    float b = -dot(f, direction);
    vec3 l = f + direction * (b / a);
    float discriminant = (radius - length(l)) * (radius + length(l));
    float q = b + (b < 0.0 ? -1.0 : 1.0) * sqrt(a * max(0.0, discriminant));
    float c = (length(f) - radius) * (length(f) + radius);
    float t0 = c / q;
    float t1 = q / a;
    float first = min(t0, t1);
    float last = max(t0, t1);
    float t = onSphere ? (b > 0.0 ? t1 : -1.0) : (first > 0.0 ? first : last);
    return discriminant >= 0.0 && radius > 0.0 && t > 0.0 && t <= tmax ? t : -1.0;
}

#endif
