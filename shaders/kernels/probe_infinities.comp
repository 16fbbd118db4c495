// One thread. Says whether infinities, NaN and -0 survive as kernels need it: ShaderSignedZeroInfNanPreserveFloat32 promises it, but drivers
// that compile with fast mathematics have made that promise too. The numbers are given, so that no compiler knows them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/infinities.glsl"

bool isNan(float x)
{
    return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u;
}

uint answer(uint bit, bool isRight)
{
    return isRight ? 1u << bit : 0u;
}

void main()
{
    answers = answer(0u, floatBitsToUint(one / zero) == 0x7f800000u && floatBitsToUint(one / -zero) == 0xff800000u) |
              answer(1u, floatBitsToUint(largest * largest) == 0x7f800000u && floatBitsToUint(one / infinity) == 0u) |
              answer(2u, isNan(zero * infinity) && isNan(infinity - infinity) && isNan(zero / zero)) |
              answer(3u, isinf(infinity) && isinf(-infinity) && !isinf(largest) && !isinf(nan)) |
              answer(4u, largest < infinity && !(infinity < infinity) && -infinity < -largest && min(infinity, one) == one) |
              answer(5u, !(nan > one) && !(nan <= one) && nan != nan) |
              answer(6u, floatBitsToUint(zero * -one) == 0x80000000u && floatBitsToUint(-zero) == 0x80000000u);
}
