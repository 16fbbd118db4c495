// Counter-based random numbers, and the search in tables that uses them.
#ifndef GLIM_LIB_HASH
#define GLIM_LIB_HASH

// pcg4d: four 32-bit numbers from four counters. Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020.
uvec4 hash4(uvec4 v)
{
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Uniform in [0, 1): the upper 24 bits, so 1.0 cannot come out and every value is equally likely.
float unitFloat(uint bits)
{
    return float(bits >> 8u) * (1.0 / 16777216.0);
}

vec2 unitFloat(uvec2 bits)
{
    return vec2(unitFloat(bits.x), unitFloat(bits.y));
}

// Uniform over [0, count): the upper word of bits * count. Probabilities of two values differ by at most 2^-32. With u * count from a
// 24-bit float they would differ by more.
uint chooseBin(uint bits, uint count)
{
    uint high, low;
    umulExtended(bits, count, high, low);
    return high;
}

// A step of the binary search for the entry of a table (host/flatten/piecewise_constant.hpp) that a random word falls to: whether it is
// another one than `middle`. low and high stay once it is found.
bool searchesOn(uvec4 entry, uint word, uint middle, inout uint low, inout uint high)
{
    bool below = word < entry.x, above = word > entry.y;
    high = below ? middle - 1u : high;
    low = above ? middle + 1u : low;
    return (below || above) && low <= high;
}

#endif
