// One thread is one path of kGuideRecords records, which hold what was there before. It clears them, opens those that the case says, and
// gives them light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/guide_records.glsl"

struct Case {
    uint opened;          // records, from the first on
    float lit, sampled;   // numbers of the records that light comes to, by ray and by light sample; 0: none
    vec3 light, direct;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        uint slot = TEST_THREAD;
        clearRecords(slot);
        for (uint i = 1u; i <= c.opened; ++i) {
            guideRecords[recordAt(slot, float(i))] = GuideRecord(vec3(i), 0.5, i, slot, 1.0, packDirect(0.25, i, false));
        }
        for (uint i = 0u; i < 2u; ++i) {  // light adds up
            addToRecord(slot, c.lit, c.light);
        }
        addDirect(slot, c.sampled, c.direct);
    }
    endTest();
}
