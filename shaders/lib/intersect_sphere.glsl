// Ray against sphere.
#ifndef GLIM_LIB_INTERSECT_SPHERE
#define GLIM_LIB_INTERSECT_SPHERE

// The upper 12 of the 24 bits: products of two such numbers are exact (Dekker, "A Floating-Point Technique for Extending the
// Available Precision", 1971).
vec3 upperBits(vec3 v)
{
    return uintBitsToFloat(floatBitsToUint(v) & 0xfffff000u);
}

// The smallest root in (0, tMax], or -1. The discriminant and the roots are those of Haines, Gunther, Akenine-Moller, "Precision
// Improvements for Ray/Sphere Intersection" (Ray Tracing Gems, ch. 7), with c = (|f|-r)(|f|+r), which keeps its digits for a ground sphere
// of 1e5 seen from 1 above. The ray is first moved near the centre by exact products: without that, 6e-4 of the rays at a sphere 1e5 radii
// away missed it; with it, none of 4e5. `onSphere`: the ray starts on this sphere. One root is then the start, so only the far side
// remains, met from within.
float intersectSphere(vec3 origin, vec3 direction, vec3 center, float radius, float tMax, bool onSphere)
{
    vec3 f = origin - center;
    float a = dot(direction, direction);
    float b = -dot(f, direction);
    float inverse = 1.0 / a;
    vec3 high = upperBits(direction);
    float most = upperBits(vec3(b * inverse)).x;
    vec3 near = (f + high * most) + (direction - high) * most;
    vec3 l = near - direction * (dot(near, direction) * inverse);
    float apart = length(l);
    float discriminant = (radius - apart) * (radius + apart);
    if (!(discriminant >= 0.0 && radius > 0.0)) {
        return -1.0;
    }
    float q = b + (b < 0.0 ? -1.0 : 1.0) * sqrt(a * discriminant);
    float c = (length(f) - radius) * (length(f) + radius);
    float t0 = c / q;
    float t1 = q * inverse;
    float first = min(t0, t1);
    float last = max(t0, t1);
    float t = onSphere ? (b > 0.0 ? t1 : -1.0) : (first > 0.0 ? first : last);
    return t > 0.0 && t <= tMax ? t : -1.0;
}

#endif
