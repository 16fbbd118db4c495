// Quotients and square roots that are rounded to nearest on every device: Vulkan allows 2.5 ulp and more. An approximation of any
// quality that Vulkan allows gives an integer close to the result's mantissa. The remainder, in wrapping integers, tells how far it is.
// Denormal operands count as zero and denormal results are zero, since a device may flush them.
#ifndef GLIM_LIB_EXACT
#define GLIM_LIB_EXACT

const uint kExactSign = 0x80000000u, kExactExponent = 0x7f800000u, kExactFraction = 0x7fffffu;
const uint kExactInfinity = 0x7f800000u, kExactNan = 0x7fc00000u;
const uint kExactUnit = 0x800000u;                            // of exponents: 2^23, which is also the mantissa's leading one
const uint kExactOne = 0x3f800000u, kExactTwo = 0x40000000u;  // as numbers
// A mantissa as the number in [1, 2) has these bits besides those of the integer in [2^23, 2^24).
const uint kExactNumber = kExactOne - kExactUnit;
// Steps are rounded down if they are half way up to this, which is more than their error: so only the next integer may be nearer.
const float kExactMargin = 1.52587890625e-5;  // 2^-16

bool exactIsNan(const uint bits)
{
    return (bits & ~kExactSign) > kExactInfinity;
}

// Whether these are the bits of a positive normal number.
bool exactIsNormal(const uint bits)
{
    return bits - kExactUnit < kExactInfinity - kExactUnit;
}

// The bits of |a / b| where an operand or the result is not normal. `size`: of the result, if there were more exponents, modulo 2^32.
uint exactSpecialQuotient(const uint a, const uint b, const uint size)
{
    bool zeroA = a < kExactUnit, zeroB = b < kExactUnit, wideA = a >= kExactInfinity, wideB = b >= kExactInfinity;
    bool overflows = size - kExactInfinity < 0xc0000000u - kExactInfinity;  // from there on are the negative exponents
    uint large = zeroB || wideA || overflows ? kExactInfinity : 0u;
    bool undefined = exactIsNan(a) || exactIsNan(b) || (zeroA && zeroB) || (wideA && wideB);
    return undefined ? kExactNan : zeroA || wideB ? 0u : large;
}

// a / b
float exactQuotient(const float a, const float b)
{
    uint bitsA = floatBitsToUint(a) & ~kExactSign, bitsB = floatBitsToUint(b) & ~kExactSign;
    uint fractionA = bitsA & kExactFraction, fractionB = bitsB & kExactFraction;
    int divisor = int(fractionB | kExactUnit);
    bool less = fractionA < fractionB;
    // The nearest integer to 2^23 dividend / divisor, both in [1, 2), or twice that if it is less than one: first off by 9 at most.
    float dividend = uintBitsToFloat(fractionA | (less ? kExactTwo : kExactOne));
    float inverse = 1.0 / uintBitsToFloat(fractionB | kExactOne);
    int quotient = int(floatBitsToUint(dividend * inverse) - kExactNumber);
    int rest = int(fractionA << (less ? 24u : 23u)) - quotient * divisor;
    int step = int(roundEven(float(rest) * (inverse * 1.1920928955078125e-7) - kExactMargin));  // 2^-23
    rest -= step * divisor;
    quotient += step + (2 * rest > divisor ? 1 : 0);  // never equal: a quotient is not half way

    uint exponent = (bitsA & kExactExponent) - (bitsB & kExactExponent) + (less ? kExactNumber - kExactUnit : kExactNumber);
    uint size = exponent + uint(quotient);
    if (!(exactIsNormal(bitsA) && exactIsNormal(bitsB) && exactIsNormal(size))) {
        size = exactSpecialQuotient(bitsA, bitsB, size);
    }
    return uintBitsToFloat(size | ((floatBitsToUint(a) ^ floatBitsToUint(b)) & kExactSign));
}

// sqrt(x)
float exactRoot(const float x)
{
    uint bits = floatBitsToUint(x);
    uint fraction = bits & kExactFraction;
    bool isEven = (bits & kExactUnit) != 0u;  // the power of two; of odd powers the mantissa takes one more
    // The nearest integer to 2^23 times the root of a number in [1, 4): first off by 5 at most.
    float number = uintBitsToFloat(fraction | (isEven ? kExactOne : kExactTwo));
    float inverse = inversesqrt(number);
    int root = int(floatBitsToUint(number * inverse) - kExactNumber);
    int rest = int(fraction << (isEven ? 23u : 24u)) - root * root;
    int step = int(roundEven(float(rest) * (inverse * 5.9604644775390625e-8) - kExactMargin));  // 2^-24
    rest -= step * (2 * root + step);
    root += step;
    root += rest > root ? 1 : 0;  // between integers lies (root + 1/2)^2, which is none

    if (exactIsNormal(bits)) {
        return uintBitsToFloat((((bits & kExactExponent) + kExactOne >> 1u) & kExactExponent) - kExactUnit + uint(root));
    }
    bool isZero = (bits & ~kExactSign) < kExactUnit;
    return uintBitsToFloat(isZero ? bits & kExactSign : bits == kExactInfinity ? kExactInfinity : kExactNan);
}

#endif
