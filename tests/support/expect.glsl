// The harness's expectations in kernels that have the push constants of a pass and the parameters of a render.
#ifndef GLIM_TESTS_EXPECT
#define GLIM_TESTS_EXPECT

#include "access/pass.glsl"

#define TEST_COUNT pass.pixelCount
#define CANARY_STEPS render.canarySteps
#include "harness/expect.glsl"

#endif
