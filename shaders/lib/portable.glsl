// Powers and exponentials from additions and products alone: all drivers give the same bits. Vulkan allows pow and exp2 larger errors.
#ifndef GLIM_LIB_PORTABLE
#define GLIM_LIB_PORTABLE

// log2(x) for normal x > 0, off by 1e-7 of |log2(x)| + 1e-7: the series of atanh for a mantissa in [sqrt(.5), sqrt(2)).
float portableLog2(float x)
{
    uint bits = floatBitsToUint(x) - 0x3f3504f3u;
    float exponent = float(int(bits) >> 23);
    float m = uintBitsToFloat((bits & 0x7fffffu) + 0x3f3504f3u);
    float s = (m - 1.0) / (m + 1.0);
    float s2 = s * s;
    float p = 2.88539008 / 9.0;
    p = p * s2 + 2.88539008 / 7.0;
    p = p * s2 + 2.88539008 / 5.0;
    p = p * s2 + 2.88539008 / 3.0;
    p = p * s2 + 2.88539008;
    return exponent + p * s;
}

// 2^x, off by 2e-7 of its size; 0 below 2^-126, and at most 2^127.
float portableExp2(float x)
{
    float whole = floor(clamp(x, -127.0, 127.0) + 0.5);
    float f = (clamp(x, -127.0, 127.0) - whole) * 0.69314718056;
    float p = 1.0 / 5040.0;
    p = p * f + 1.0 / 720.0;
    p = p * f + 1.0 / 120.0;
    p = p * f + 1.0 / 24.0;
    p = p * f + 1.0 / 6.0;
    p = p * f + 0.5;
    p = p * f + 1.0;
    p = p * f + 1.0;
    return whole < -126.0 ? 0.0 : p * uintBitsToFloat(uint(int(whole) + 127) << 23u);
}

// Off by 2e-7 (1 + |x|) of its size.
float portableExp(float x)
{
    return portableExp2(x * 1.44269504);
}

// x^y for x >= 0; 0 for x up to 1e-37. Off by 2e-7 (1 + |y| (1 + |log2 x|)) of its size.
float portablePow(float x, float y)
{
    return x > 1e-37 ? portableExp2(y * portableLog2(x)) : 0.0;
}

#endif
