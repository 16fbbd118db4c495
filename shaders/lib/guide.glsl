// Directions as points of the unit square, for quadtrees over them, and seen from another point than the one they start at.
#ifndef GLIM_LIB_GUIDE
#define GLIM_LIB_GUIDE

#include "octahedral.glsl"

// The octahedral map, in [0, 1]^2. It needs no angles; areas vary by a factor of 5, which pdfOfSquare() makes up for. 1e-20:
// the light sample that does not exist has w = 0, and no unit vector is as short.
vec2 squareFromDirection(vec3 w)
{
    vec2 p = w.xy / max(abs(w.x) + abs(w.y) + abs(w.z), 1e-20);
    return 0.5 + 0.5 * (w.z >= 0.0 ? p : octahedralWrap(p, 1.0));
}

vec3 directionFromSquare(vec2 square)
{
    vec2 p = 2.0 * square - 1.0;
    float z = 1.0 - abs(p.x) - abs(p.y);
    vec3 w = vec3(z >= 0.0 ? p : octahedralWrap(p, 1.0), z);
    return w / sqrt(dot(w, w));
}

// Per steradian at w, of a density of 1 over the square. A face of the octahedron at distance r along w is seen at a cosine of
// 1 / (sqrt(3) r), and its area is sqrt(3) times that of its projection, of which the square has a quarter.
float pdfOfSquare(vec3 w)
{
    float r = 1.0 / max(abs(w.x) + abs(w.y) + abs(w.z), 1e-20);
    return 0.25 * (r * r * r);
}

// The unit direction from the centre to the point `focus` metres from the origin along w. `offset`: from the centre to the origin, shorter
// than `focus`. `jacobian`: solid angle there per solid angle here.
vec3 seeFromCenter(vec3 offset, float focus, vec3 w, out float jacobian)
{
    vec3 v = offset + focus * w;
    float square = dot(v, v);
    vec3 seen = v / sqrt(square);
    jacobian = focus * focus * dot(w, seen) / square;
    return seen;
}

// Its inverse.
vec3 seeFromOrigin(vec3 offset, float focus, vec3 seen)
{
    float along = dot(offset, seen);
    float t = along + sqrt(max(0.0, along * along + focus * focus - dot(offset, offset)));
    vec3 v = t * seen - offset;
    return v / sqrt(dot(v, v));
}

#endif
