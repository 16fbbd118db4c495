#include "host/gpu/arithmetic.hpp"

#include "host/error.hpp"
#include "host/spirv/adverse.hpp"
#include "host/spirv/exact.hpp"
#include "kernels.hpp"

#include <charconv>

namespace glim {
namespace {

constexpr std::uint32_t kRoundingModeRteCapability = 4467, kRoundingModeRte = 4462;  // SPIR-V, sections 3.6 and 3.31

}  // namespace

Arithmetic parseArithmetic(Arithmetic usual, const std::string& asked)
{
    const std::string native = "native,", adverse = "adverse:";
    usual.exact = asked != "native" && asked.substr(0, native.size()) != native;
    if (asked == "native" || asked == "exact") {
        return usual;
    }
    const std::string rest = usual.exact ? asked : asked.substr(native.size());
    if (rest.substr(0, adverse.size()) == adverse) {
        std::uint32_t seed = 0;
        const auto [last, error] = std::from_chars(rest.data() + adverse.size(), rest.data() + rest.size(), seed);
        if (error == std::errc() && last == rest.data() + rest.size()) {
            usual.adverse = seed;
            return usual;
        }
    }
    throw InputError(MessageId::UnknownName, {part::place("GLIM_ARITHMETIC"), "=", part::value(asked), ": it should be ",
                                              part::expected("exact, native, adverse:SEED or native,adverse:SEED"), "."});
}

std::vector<std::uint32_t> computeBy(const Arithmetic& arithmetic, const std::vector<std::uint32_t>& kernel)
{
    if (arithmetic == Arithmetic{.exact = false}) {
        return kernel;
    }
    static const spirv::Module exact(kernels::exact_arithmetic.words());
    static const spirv::Module adverse(kernels::adverse_arithmetic.words());
    spirv::Module module(kernel);
    if (arithmetic.exact) {
        makeExact(module, exact);
    }
    if (arithmetic.adverse) {
        makeAdverse(module, adverse, *arithmetic.adverse);
    }
    if (arithmetic.declaresRounding) {
        module.addCapability(kRoundingModeRteCapability);
        module.addExecutionMode(kRoundingModeRte, 32);
    }
    return module.assemble();
}

}  // namespace glim
