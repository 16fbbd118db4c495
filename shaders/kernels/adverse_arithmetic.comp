// Never dispatched: host/spirv/adverse.hpp takes these functions out of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/adverse.glsl"

void main()
{
    adverseFlush(0.0);
    adverseMove(1.0, 2u, 1u);
    adverseShift(1.0, 1u);
    adverseMin(1.0, 2.0, 1u);
    adverseMax(1.0, 2.0, 1u);
    adverseInt(1.0, 1u);
    adverseUint(1.0, 1u);
}
