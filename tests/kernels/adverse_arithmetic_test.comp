// One thread is two numbers and a seed. Result: what adverse arithmetic makes of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/adverse.glsl"

struct Case {
    float x, y;
    uint seed;
};

struct Result {
    float flushed, moved, shifted, least, most;
    int integer;
    uint natural;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        results[TEST_THREAD] = Result(adverseFlush(c.x), adverseMove(c.x, 3u, c.seed), adverseShift(c.x, c.seed),
                                      adverseMin(c.x, c.y, c.seed), adverseMax(c.x, c.y, c.seed), adverseInt(c.x, c.seed),
                                      adverseUint(c.x, c.seed));
    }
    endTest();
}
