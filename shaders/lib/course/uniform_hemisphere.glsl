// Directions that are uniform over the hemisphere.
#ifndef GLIM_LIB_COURSE_UNIFORM_HEMISPHERE
#define GLIM_LIB_COURSE_UNIFORM_HEMISPHERE

#include "lib/warp.glsl"

// About +z, z > 0. u in [0, 1)^2.
vec3 sampleUniformHemisphere(vec2 u)
{
    float r = sqrt(u.x * (2.0 - u.x));
    return vec3(r * sampleCircle(u.y), 1.0 - u.x);
}

// Per steradian.
float pdfUniformHemisphere()
{
    return 1.0 / (2.0 * kPi);
}

#endif
