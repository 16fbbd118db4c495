// The program of tests of kernels that are to compute as they are, checked by the validation layers. The environment may ask for other
// things.
#include <gtest/gtest.h>

#include <cstdlib>

int main(int argc, char** argv)
{
    testing::InitGoogleTest(&argc, argv);
    setenv("GLIM_ARITHMETIC", "native", 0);
    setenv("GLIM_VALIDATION", "1", 0);
    return RUN_ALL_TESTS();
}
