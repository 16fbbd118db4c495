// One thread is one draw.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/alias.glsl"
#include "shared/scene_types.h"

struct Table {
    uint count;
    AliasEntry entries[16];
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Table table; };
layout(set = 0, binding = kBindResults, scalar) buffer Results { uint drawn[16]; };

// The threads form an even grid over both numbers.
const uint kSide = 1024u;

void main()
{
    if (isTestThread()) {
        uvec2 bits = uvec2(TEST_THREAD % kSide, TEST_THREAD / kSide) * (0xffffffffu / (kSide - 1u));
        uint bin = chooseBin(bits.x, table.count);
        EXPECT_TRUE(bin < table.count);
        AliasEntry entry = table.entries[bin];
        atomicAdd(drawn[chooseAlias(bin, entry.threshold, entry.other, bits.y)], 1u);
    }
    EXPECT_EQUAL(chooseBin(0xffffffffu, 1000003u), 1000002u);
    EXPECT_EQUAL(chooseBin(0u, 1000003u), 0u);
    EXPECT_EQUAL(chooseAlias(5u, 7u, 9u, 6u), 5u);
    EXPECT_EQUAL(chooseAlias(5u, 7u, 9u, 7u), 9u);
    endTest();
}
