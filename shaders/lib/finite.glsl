#ifndef GLIM_LIB_FINITE
#define GLIM_LIB_FINITE

// GLSL has no literal for it, and uintBitsToFloat is not a constant expression.
#define kInfinity uintBitsToFloat(0x7f800000u)

// 2^-126. What is smaller is denormal, and devices may take it for 0 in some operations and not in others.
const float kSmallestNormal = 1.17549435e-38;

// Tests the bits, because a driver may assume that no float is NaN or infinite.
bool isFinite(float x)
{
    return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

bool isFinite(vec3 v)
{
    return isFinite(v.x) && isFinite(v.y) && isFinite(v.z);
}

#endif
