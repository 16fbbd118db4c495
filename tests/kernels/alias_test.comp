// One thread is one entry of an alias table, and one draw. Result: what the thread's draws chose.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/alias.glsl"
#include "lib/hash.glsl"
#include "shared/scene_types.h"

struct Case {
    AliasEntry entry;
    uint first, last;  // numbers that must choose this bin, and whose neighbours must not
};

const uint kDraws = 8u;

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { uint results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        uint count = pass.pixelCount;
        uint bin = TEST_THREAD;
        EXPECT_EQUAL(chooseBin(c.first, count), bin);
        EXPECT_EQUAL(chooseBin(c.last, count), bin);
        EXPECT_EQUAL(chooseBin(c.first - 1u, count), (bin + count - 1u) % count);
        EXPECT_EQUAL(chooseBin(c.last + 1u, count), (bin + 1u) % count);
        EXPECT_EQUAL(chooseAlias(bin, c.entry.threshold, c.entry.other, 0u), bin);
        EXPECT_EQUAL(chooseAlias(bin, c.entry.threshold, c.entry.other, c.entry.threshold - 1u), bin);
        EXPECT_EQUAL(chooseAlias(bin, c.entry.threshold, c.entry.other, c.entry.threshold), c.entry.other);
        EXPECT_EQUAL(chooseAlias(bin, c.entry.threshold, c.entry.other, 0xffffffffu), c.entry.other);
        for (uint i = 0u; i < kDraws; ++i) {
            uvec4 bits = hash4(uvec4(TEST_THREAD, i, pass.seed, 0u));
            uint drawn = chooseBin(bits.x, count);
            AliasEntry entry = cases[drawn].entry;
            results[TEST_THREAD * kDraws + i] = chooseAlias(drawn, entry.threshold, entry.other, bits.y);
        }
    }
    endTest();
}
