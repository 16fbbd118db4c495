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
    int less = mantissaA < mantissaB ? 1 : 0;
    // The nearest integer to mantissaA 2^(23 + less) / mantissaB, which is in [2^23, 2^24]: first off by 10 at most, then by 1.
    float inverse = 1.0 / float(mantissaB);
    uint scaled = mantissaA << less;
    uint quotient = uint(float(scaled) * inverse * 8388608.0);
    int rest = int((scaled << 23u) - quotient * mantissaB);
    int step = int(roundEven(float(rest) * inverse));
    int twice = 2 * (rest - step * int(mantissaB));  // never as large as the mantissa: a quotient is not half way
    int bits = int(quotient) + step + (twice > int(mantissaB) ? 1 : 0) - (twice < -int(mantissaB) ? 1 : 0);

    int exponent = exponentA - exponentB - less + 126;  // the mantissa's leading one is to be added
    bits += clamp(exponent, -2, 253) * int(kExactOne);
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
    // The nearest integer to the root of mantissa 2^23, which is in [2^23, 2^24): first off by 20 at most, then by 1.
    int root = int(sqrt(float(mantissa) * 8388608.0));
    int rest = int((mantissa << 23u) - uint(root) * uint(root));
    int step = int(roundEven(float(rest) * (0.5 / float(root))));
    rest -= step * (2 * root + step);
    root += step;
    root += (rest > root ? 1 : 0) - (rest <= -root ? 1 : 0);  // between integers lies (root + 1/2)^2, which is none

    uint size = (((exponent + 127u) >> 1u) - 1u) * kExactOne + uint(root);
    bool negative = (bits & kExactSign) != 0u;
    uint special = exponent == 0u ? bits & kExactSign : exactIsNan(bits) || negative ? kExactNan : kExactInfinity;
    return uintBitsToFloat(exponent == 0u || exponent == 255u || negative ? special : size);
}

#endif
