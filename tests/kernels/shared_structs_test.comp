// One thread reads every field of every shared struct as the host wrote it, and writes every field for the host to read. The
// n-th word of the list holds 1000 + n.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "shared_fields.h"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { EverySharedStruct fromHost; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { EverySharedStruct toHost; };

uint number = 1000u;

float next()
{
    return float(number++);
}

uint countWrong()
{
    uint wrong = 0u;
    number = 1000u;
#define U(field) wrong += float(fromHost.field) == next() ? 0u : 1u;
#define F(field) U(field)
#define U2(field) U(field.x) U(field.y)
#define F2(field) U2(field)
#define U3(field) U2(field) U(field.z)
#define F3(field) U3(field)
#include "shared_fields.h"
#undef U
#undef F
    return wrong;
}

void fill()
{
    number = 1000u;
#define U(field) toHost.field = uint(next());
#define F(field) toHost.field = next();
#undef F2
#undef F3
#define F2(field) F(field.x) F(field.y)
#define F3(field) F2(field) F(field.z)
#include "shared_fields.h"
}

void main()
{
    if (TEST_THREAD == 0u) {
        EXPECT_EQUAL(countWrong(), 0u);
        EXPECT_EQUAL(number, 1000u + kSharedWords);
        fill();
    }
    endTest();
}
