#include "host/spirv/mark.hpp"

#include "host/spirv/expand.hpp"

#include <stdexcept>

namespace glim::spirv {
namespace {

constexpr std::uint32_t kSignedZeroInfNanPreserveCapability = 4466, kSignedZeroInfNanPreserve = 4461;

}  // namespace

void markFloats(Module& module)
{
    expand(module);
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

}  // namespace glim::spirv
