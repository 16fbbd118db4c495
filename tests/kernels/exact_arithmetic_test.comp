// One thread is one pair of numbers. Writes their quotient and the square root of the first, as kernels compute them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/bindings.h"

layout(local_size_x_id = 0) in;

layout(set = 0, binding = kBindProbed, scalar) buffer Numbers { vec2 numbers[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < uint(numbers.length())) {
        vec2 pair = numbers[i];
        numbers[i] = vec2(pair.x / pair.y, sqrt(pair.x));
    }
}
