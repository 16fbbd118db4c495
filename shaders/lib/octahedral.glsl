// Unit vectors in 32 bits. Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 3(2), 2014.
#ifndef GLIM_LIB_OCTAHEDRAL
#define GLIM_LIB_OCTAHEDRAL

// The lower half of the octahedron, folded over the upper one, whose corners are `one` from the middle.
vec2 octahedralWrap(vec2 v, float one)
{
    return (one - abs(v.yx)) * vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
}

const float kNormalSteps = 32767.0;

// Two signed 16-bit fractions, rounded.
uint encodeNormal(vec3 n)
{
    vec2 p = n.xy * (kNormalSteps / (abs(n.x) + abs(n.y) + abs(n.z)));
    ivec2 steps = ivec2(roundEven(n.z >= 0.0 ? p : octahedralWrap(p, kNormalSteps)));
    return uint(steps.x & 0xffff) | uint(steps.y) << 16u;
}

// A unit vector to float's rounding, within 6.5e-5 radians of the vector that was encoded.
vec3 decodeNormal(uint bits)
{
    ivec2 steps = ivec2(int(bits << 16u) >> 16, int(bits) >> 16);
    vec2 p = vec2(steps) * (1.0 / kNormalSteps);
    float z = 1.0 - abs(p.x) - abs(p.y);
    vec3 n = vec3(z >= 0.0 ? p : octahedralWrap(p, 1.0), z);
    return n / sqrt(dot(n, n));
}

#endif
