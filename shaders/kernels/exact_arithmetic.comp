// Never dispatched: host/spirv/exact.hpp takes these functions out of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/exact.glsl"

void main()
{
    exactQuotient(1.0, 2.0);
    exactRoot(2.0);
}
