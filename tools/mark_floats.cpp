// mark_floats IN.spv OUT.spv: makes the results of float arithmetic unique but for divisions and roots. Sums and products are written out
// in one order (host/spirv/expand.hpp), the result of every float arithmetic instruction is decorated NoContraction, and the module
// declares that signed zeros, infinities and NaN are kept: kernels let distances be infinite and guard against NaN by comparisons.
//
// Vulkan lets a driver contract and reassociate undecorated float operations. GLSL's `precise` does the same job but does not reach into
// called functions. With every operation marked, kernels with and without a feature, in both schedules and on both versions of the software
// driver compute the same bits; measured cost there: none.
//
// It also refuses OpExtInst Fma: `fma` may be unfused, so nothing may rest on it.
#include "host/spirv/expand.hpp"

#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace {

using namespace glim::spirv;

constexpr std::uint32_t kSignedZeroInfNanPreserveCapability = 4466, kSignedZeroInfNanPreserve = 4461;

Words readWords(const char* path)
{
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    Words words(bytes.size() / 4);
    bytes.copy(reinterpret_cast<char*>(words.data()), words.size() * 4);
    return words;
}

void mark(Module& module)
{
    for (const Instruction& instruction : module.functions) {
        if (isFloatArithmetic(instruction.opcode())) {
            module.decorate(instruction.result, kNoContraction);
        }
        if (instruction.isExtended(kGlslFma)) {
            throw std::runtime_error("uses fma(), which a driver may leave unfused");
        }
    }
    module.addCapability(kSignedZeroInfNanPreserveCapability);
    module.addExecutionMode(kSignedZeroInfNanPreserve, 32);
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 3) {
        std::fprintf(stderr, "usage: mark_floats IN.spv OUT.spv\n");
        return 2;
    }
    try {
        Module module(readWords(argv[1]));
        expand(module);
        mark(module);
        const Words words = module.assemble();
        std::ofstream out(argv[2], std::ios::binary);
        out.write(reinterpret_cast<const char*>(words.data()), static_cast<std::streamsize>(words.size() * sizeof(words[0])));
        return out.flush().good() ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", argv[1], error.what());
        return 1;
    }
}
