// Powers, exponentials and angles from additions, products and quotients alone: all drivers give the same bits. Vulkan allows pow, exp2,
// sin, cos and atan larger errors.
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
    return x < -126.0 ? 0.0 : p * uintBitsToFloat(uint(int(whole) + 127) << 23u);
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

// `angle` of the point (|x|, |y|) from the nearer axis, as the angle of (x, y) from the x axis, in [-pi, pi].
float unfoldAngle(float angle, float y, float x)
{
    angle = abs(y) > abs(x) ? 1.57079633 - angle : angle;
    angle = x < 0.0 ? 3.14159265 - angle : angle;
    return y < 0.0 ? -angle : angle;
}

// The angle of the point (x, y), off by 2.2e-7 of its size; 0 at (0, 0). The polynomial is a minimax fit for slopes up to tan(pi/8).
float portableAtan2(float y, float x)
{
    float high = max(abs(x), abs(y));
    float low = min(abs(x), abs(y));
    bool steep = low > 0.41421356 * high;
    float above = steep ? low - high : low;
    float below = steep ? low + high : high;
    float slope = below > 0.0 ? above / below : 0.0;
    float s2 = slope * slope;
    float p = 0.08060309;
    p = p * s2 - 0.1387985;
    p = p * s2 + 0.19977926;
    p = p * s2 - 0.33332955;
    float angle = slope + slope * (s2 * p);
    return unfoldAngle(steep ? 0.785398163 + angle : angle, y, x);
}

// (cos x, sin x) for |x| <= pi/2; the cosine is off by 1.3e-7, the sine by 1.3e-7 of its size. Minimax fits.
vec2 portableCosSin(float x)
{
    float x2 = x * x;
    float c = -2.6193815e-7;
    c = c * x2 + 2.47693042e-5;
    c = c * x2 - 1.38885692e-3;
    c = c * x2 + 4.16666558e-2;
    c = c * x2 - 0.5;
    float s = 2.60578059e-6;
    s = s * x2 - 1.98096029e-4;
    s = s * x2 + 8.33306625e-3;
    s = s * x2 - 0.166666596;
    return vec2(1.0 + x2 * c, x + x * (x2 * s));
}

#endif
