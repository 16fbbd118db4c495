// What a test kernel reports, in both languages.
#ifndef GLIM_TESTS_REPORT_H
#define GLIM_TESTS_REPORT_H
#include "../../shaders/shared/vocabulary.h"

GLIM_SHARED_BEGIN

GLIM_CONST uint kMaxFailures = 16u;
GLIM_CONST uint kLineWords = 32u;          // checks stand in the first 1,024 lines of a test kernel
GLIM_CONST uint kSentinel = 0x5eed1e55u;   // the host writes it; a kernel that ran has replaced it

struct Failure {
    uint line;
    uint thread;
    float actual, expected, tolerance;
};

struct Report {
    uint sentinel;
    uint threads;             // that ran to the end
    uint loopsSpent;          // threads whose loop budget was spent
    uint failureCount;
    uint lines[kLineWords];   // one bit per line whose check has run
    Failure failures[kMaxFailures];
};

GLIM_SHARED_END
#endif
