// libFuzzer's entry. A broken contract aborts, which libFuzzer reports with the input.
#include "tests/fuzz/targets.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (const auto defect = glim::fuzz::runTarget(GLIM_FUZZ_TARGET, {data, size})) {
        std::fprintf(stderr, "The input breaks the contract: %s\n", defect->c_str());
        std::abort();
    }
    return 0;
}
