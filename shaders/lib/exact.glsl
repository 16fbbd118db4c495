// Quotients and square roots that are rounded to nearest on every device: Vulkan allows 2.5 ulp and more. An approximation of any
// quality that Vulkan allows gives an integer close to the result's mantissa. The remainder, in wrapping integers, tells how far it is.
// Denormal operands count as zero and denormal results are zero, since a device may flush them.
#ifndef GLIM_LIB_EXACT
#define GLIM_LIB_EXACT

const uint kExactInfinity = 0x7f800000u, kExactNan = 0x7fc00000u, kExactSign = 0x80000000u, kExactOne = 0x800000u;  // one: 2^23

// The mantissa with its leading one, in [2^23, 2^24).
uint exactMantissa(const uint bits)
{
    return (bits & 0x7fffffu) | kExactOne;
}

bool exactIsNan(const uint bits)
{
    return (bits & ~kExactSign) > kExactInfinity;
}

// a / b
float exactQuotient(const float a, const float b)
{
    uint bitsA = floatBitsToUint(a), bitsB = floatBitsToUint(b);
    int exponentA = int(bitsA >> 23u & 0xffu), exponentB = int(bitsB >> 23u & 0xffu);
    uint mantissaA = exactMantissa(bitsA), mantissaB = exactMantissa(bitsB);
    bool less = mantissaA < mantissaB;
    uint shift = less ? 24u : 23u;
    // The integer part of mantissaA 2^shift / mantissaB, which is in [2^23, 2^24), off by 10 at most.
    float inverse = 1.0 / float(mantissaB);
    uint quotient = uint(float(mantissaA) * inverse * (less ? 16777216.0 : 8388608.0));
    int rest = int((mantissaA << shift) - quotient * mantissaB);
    int step = int(floor(float(rest) * inverse));  // off by one at most
    quotient += uint(step);
    rest -= step * int(mantissaB);
    int last = rest < 0 ? -1 : rest >= int(mantissaB) ? 1 : 0;
    quotient += uint(last);
    rest -= last * int(mantissaB);
    quotient += 2 * rest > int(mantissaB) ? 1u : 0u;  // a quotient of two mantissas is never half way

    int exponent = exponentA - exponentB + (less ? 125 : 126);  // the mantissa's leading one is to be added
    int bits = clamp(exponent, -2, 253) * int(kExactOne) + int(quotient);
    uint size = exponent > 253 ? kExactInfinity : bits < int(kExactOne) ? 0u : uint(bits);
    bool zeroA = exponentA == 0, zeroB = exponentB == 0, wideA = exponentA == 255, wideB = exponentB == 255;
    size = zeroA || wideB ? 0u : zeroB || wideA ? kExactInfinity : size;
    bool undefined = exactIsNan(bitsA) || exactIsNan(bitsB) || (zeroA && zeroB) || (wideA && wideB);
    return uintBitsToFloat(undefined ? kExactNan : size | ((bitsA ^ bitsB) & kExactSign));
}

// sqrt(x)
float exactRoot(const float x)
{
    uint bits = floatBitsToUint(x);
    uint exponent = bits >> 23u & 0xffu;
    uint mantissa = exactMantissa(bits) << (1u - (exponent & 1u));  // of an even power of two
    // The integer part of the root of mantissa 2^23, which is in [2^23, 2^24), off by 20 at most.
    uint root = uint(sqrt(float(mantissa) * 8388608.0));
    int rest = int((mantissa << 23u) - root * root);
    int step = int(floor(float(rest) * (0.5 / float(root))));  // off by one at most
    rest -= step * (2 * int(root) + step);
    root += uint(step);
    int last = rest < 0 ? -1 : rest > 2 * int(root) ? 1 : 0;
    rest -= last * (2 * int(root) + last);
    root += uint(last);
    root += rest > int(root) ? 1u : 0u;  // (root + 1/2)^2 is no integer

    uint size = (((exponent + 127u) >> 1u) - 1u) * kExactOne + root;
    bool negative = (bits & kExactSign) != 0u;
    uint special = exponent == 0u ? bits & kExactSign : exactIsNan(bits) || negative ? kExactNan : kExactInfinity;
    return uintBitsToFloat(exponent == 0u || exponent == 255u || negative ? special : size);
}

#endif
