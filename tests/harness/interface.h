// What a test kernel and the host agree on, in both languages: bindings, push constants, the report.
#ifndef HARNESS_INTERFACE_H
#define HARNESS_INTERFACE_H
#include "../../shaders/shared/vocabulary.h"

GLIM_SHARED_BEGIN

// In set 0.
GLIM_CONST uint kBindCases = 30u;
GLIM_CONST uint kBindReport = 31u;
GLIM_CONST uint kBindResults = 32u;

GLIM_CONST uint kTestWorkgroup = 64u;  // threads
GLIM_CONST uint kMaxFailures = 16u;
GLIM_CONST uint kLineWords = 32u;         // checks are in the first 1,024 lines of a test kernel
GLIM_CONST uint kSentinel = 0x5eed1e55u;  // the host writes it, and a kernel that runs replaces it

// Push constants of a kernel that includes kernel_test.glsl.
struct TestPush {
    uint count;  // of the cases, or of the threads that are asked for
    uint seed;
    uint canarySteps;
};

struct Failure {
    uint line;
    uint thread;
    float actual, expected, tolerance;
};

struct Report {
    uint sentinel;
    uint threads;     // the number of threads that ran to their end
    uint loopsSpent;  // the number of threads that found the driver's loop budget spent
    uint failureCount;
    uint lines[kLineWords];  // one bit per line, set if its check has run
    Failure failures[kMaxFailures];
};

GLIM_SHARED_END
#endif
