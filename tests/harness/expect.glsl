// Expectations on the device. Each one takes one line. The host reports a failure at that line, and also if the check never ran. A test
// kernel calls endTest() last. Who includes this has defined TEST_COUNT, the number of cases, and CANARY_STEPS, 3 of the host.
#ifndef HARNESS_EXPECT
#define HARNESS_EXPECT

#include "../../shaders/lib/canary.glsl"
#include "interface.h"

layout(set = 0, binding = kBindReport, scalar) buffer ReportBuffer { Report report; };

#define TEST_THREAD gl_GlobalInvocationID.x

bool isTestThread()
{
    return TEST_THREAD < TEST_COUNT;
}

void expectThat(uint line, bool holds, float actual, float expected, float tolerance)
{
    atomicOr(report.lines[line / 32u], 1u << (line % 32u));
    if (!holds) {
        uint place = atomicAdd(report.failureCount, 1u);
        if (place < kMaxFailures) {
            report.failures[place] = Failure(line, TEST_THREAD, actual, expected, tolerance);
        }
    }
}

bool isNear(float actual, float expected, float tolerance)
{
    return abs(actual - expected) <= tolerance;  // false for NaN
}

// The tolerance is absolute.
#define EXPECT_NEAR(actual, expected, tolerance) \
    expectThat(__LINE__, isNear(actual, expected, tolerance), actual, expected, tolerance)
// The tolerance is relative to the expected value.
#define EXPECT_CLOSE(actual, expected, relative) \
    expectThat(__LINE__, isNear(actual, expected, abs(expected) * (relative)), actual, expected, abs(expected) * (relative))
// The tolerance is for the distance between two vectors.
#define EXPECT_NEAR_VECTOR(actual, expected, tolerance) \
    expectThat(__LINE__, length((actual) - (expected)) <= (tolerance), length((actual) - (expected)), 0.0, tolerance)
#define EXPECT_EQUAL(actual, expected) \
    expectThat(__LINE__, (actual) == (expected), float(actual), float(expected), 0.0)
#define EXPECT_TRUE(condition) expectThat(__LINE__, condition, 0.0, 1.0, 0.0)

void endTest()
{
    report.sentinel = 0u;
    if (isLoopBudgetSpent(CANARY_STEPS)) {
        atomicAdd(report.loopsSpent, 1u);
    }
    atomicAdd(report.threads, 1u);
}

#endif
