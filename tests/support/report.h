// The report of a test kernel, in both languages.
#ifndef GLIM_TESTS_REPORT_H
#define GLIM_TESTS_REPORT_H
#include "../../shaders/shared/vocabulary.h"

GLIM_SHARED_BEGIN

GLIM_CONST uint kMaxFailures = 16u;
GLIM_CONST uint kLineWords = 32u;         // checks are in the first 1,024 lines of a test kernel
GLIM_CONST uint kSentinel = 0x5eed1e55u;  // the host writes it, and a kernel that runs replaces it

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
