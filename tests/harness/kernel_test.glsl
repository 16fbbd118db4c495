// What a test kernel includes first: its workgroup, its push constants `test`, the checks. Then it declares Cases and Results as it needs
// them.
#ifndef HARNESS_KERNEL_TEST
#define HARNESS_KERNEL_TEST

#include "interface.h"

layout(local_size_x = kTestWorkgroup) in;
layout(push_constant, scalar) uniform TestPushBlock { TestPush test; };

#define TEST_COUNT test.count
#define CANARY_STEPS test.canarySteps
#include "expect.glsl"

#endif
