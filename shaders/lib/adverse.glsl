// What a device may do to floats at worst (Vulkan, "Precision and Operation of SPIR-V Instructions"): host/spirv/adverse.hpp puts these
// functions around every operation, to show what a picture leans on.
#ifndef GLIM_LIB_ADVERSE
#define GLIM_LIB_ADVERSE

const uint kAdverseWorst = 0u;  // the seed whose errors are the largest ones away from zero

uint adverseHash(const uint bits, const uint seed)
{
    uint h = (bits ^ seed) * 747796405u + 2891336453u;
    h = ((h >> ((h >> 28u) + 4u)) ^ h) * 277803737u;
    return (h >> 22u) ^ h;
}

// Denormal numbers are zero.
float adverseFlush(const float x)
{
    uint bits = floatBitsToUint(x);
    return uintBitsToFloat((bits & 0x7f800000u) == 0u ? bits & 0x80000000u : bits);
}

// A result that is off by up to `ulps`. Zero, infinity and NaN stay, and so do the largest and the smallest numbers.
float adverseMove(const float x, const uint ulps, const uint seed)
{
    uint bits = floatBitsToUint(x);
    uint exponent = bits >> 23u & 0xffu;
    uint up = seed == kAdverseWorst ? 2u * ulps : adverseHash(bits, seed) % (2u * ulps + 1u);
    return uintBitsToFloat(exponent < 2u || exponent > 253u ? bits : bits + up - ulps);
}

// A result that is off by up to 2^-11, as of sin and cos.
float adverseShift(const float x, const uint seed)
{
    uint h = seed == kAdverseWorst ? 65535u : adverseHash(floatBitsToUint(x), seed) & 0xffffu;
    return x + (float(h) - 32768.0) * 1.4901161e-8;  // 2^-26
}

// Of two zeros, and of a number and NaN, either one is the smaller and the larger.
float adverseMin(const float a, const float b, const uint seed)
{
    bool first = (adverseHash(floatBitsToUint(a), seed) & 1u) != 0u;
    return a < b ? a : b < a ? b : first ? a : b;
}

float adverseMax(const float a, const float b, const uint seed)
{
    bool first = (adverseHash(floatBitsToUint(a), seed) & 1u) != 0u;
    return a > b ? a : b > a ? b : first ? a : b;
}

// What an integer cannot be becomes any.
int adverseInt(const float x, const uint seed)
{
    return x >= -2147483648.0 && x < 2147483648.0 ? int(x) : int(adverseHash(floatBitsToUint(x), seed));
}

uint adverseUint(const float x, const uint seed)
{
    return x > -1.0 && x < 4294967296.0 ? uint(x) : adverseHash(floatBitsToUint(x), seed);
}

#endif
