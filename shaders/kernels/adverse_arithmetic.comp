// One thread is one number. host/spirv/adverse.hpp takes the functions out of this kernel, which itself only names them all.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/adverse.glsl"
#include "shared/bindings.h"

layout(local_size_x_id = 0) in;

layout(set = 0, binding = kBindProbed, scalar) buffer Numbers { float numbers[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < uint(numbers.length())) {
        float x = adverseShift(adverseMove(adverseFlush(numbers[i]), 2u, i), i);
        numbers[i] = adverseMin(x, float(adverseInt(x, i)), i) + adverseMax(x, float(adverseUint(x, i)), i);
    }
}
