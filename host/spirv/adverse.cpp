#include "host/spirv/adverse.hpp"

#include "host/spirv/builder.hpp"
#include "host/spirv/import.hpp"

#include <algorithm>
#include <optional>
#include <set>

namespace glim::spirv {
namespace {

// How far the result of an instruction may be off, in ulp, where Vulkan says so in ulp. The native result may be off by half of one
// already.
std::optional<std::uint32_t> allowedUlps(const Instruction& i)
{
    if (i.opcode() == kOpFDiv) {
        return 2;  // 2.5
    }
    if (i.opcode() != kOpExtInst) {
        return {};
    }
    switch (i.words[4]) {
    case kGlslInverseSqrt: return 1;  // 2
    case kGlslSqrt: return 4;         // as 1 / inversesqrt
    case kGlslAtan:
    case kGlslAtan2:
    case kGlslAsin:
    case kGlslAcos: return 4095;  // 4096
    case kGlslExp:
    case kGlslExp2:
    case kGlslLog:
    case kGlslLog2: return 2;  // 3 and more
    case kGlslPow: return 16;  // as exp2(y log2 x)
    default: return {};
    }
}

// An extended instruction with floats. Those with integers are left alone by flush().
bool isExtended(const Instruction& i) { return i.opcode() == kOpExtInst && i.words[4] <= kGlslFMax; }

bool isComparison(std::uint32_t opcode) { return opcode >= 180 && opcode <= 191; }  // OpFOrdEqual to OpFUnordGreaterThanEqual

class Adversary {
public:
    Adversary(Module& module, const Module& library, std::uint32_t seed, std::vector<Instruction>& out)
        : module_(module),
          importer_(module, library),
          build_(module, out),
          seed_(seed)
    {}

    void replace(Instruction i)
    {
        if (isFloatArithmetic(i.opcode()) || isComparison(i.opcode()) || isExtended(i) || i.opcode() == kOpConvertFToU ||
            i.opcode() == kOpConvertFToS) {
            for (std::size_t at = i.opcode() == kOpExtInst ? 5 : 3; at < i.words.size(); ++at) {
                i.words[at] = flush(i.words[at]);
            }
        }
        if (i.opcode() == kOpConvertFToU || i.opcode() == kOpConvertFToS) {
            const Id function = importer_.function(i.opcode() == kOpConvertFToU ? "adverseUint" : "adverseInt");
            build_.callByComponent(function, i.type, {i.words[3], nextSeed()}, i.result);
        } else if (i.isExtended(kGlslFMin) || i.isExtended(kGlslFMax)) {
            const Id function = importer_.function(i.isExtended(kGlslFMin) ? "adverseMin" : "adverseMax");
            build_.callByComponent(function, i.type, {i.words[5], i.words[6], nextSeed()}, i.result);
        } else if (i.isExtended(kGlslSin) || i.isExtended(kGlslCos)) {
            const Id result = rename(i);
            build_.callByComponent(importer_.function("adverseShift"), i.type, {build_.append(i), nextSeed()}, result);
        } else if (const auto ulps = allowedUlps(i)) {
            const Id result = rename(i);
            const Id moved = build_.callByComponent(importer_.function("adverseMove"), i.type,
                                                    {build_.append(i), module_.constantUint(*ulps), nextSeed()});
            clean_.insert(build_.callByComponent(importer_.function("adverseFlush"), i.type, {moved}, result));
        } else if (isFloatArithmetic(i.opcode())) {
            const Id result = rename(i);
            clean_.insert(build_.callByComponent(importer_.function("adverseFlush"), i.type, {build_.append(i)}, result));
        } else {
            build_.append(std::move(i));
        }
    }

    std::vector<Instruction> takeFunctions() { return importer_.takeFunctions(); }

private:
    // A float that may be denormal without its being so; anything else as it is.
    Id flush(Id operand)
    {
        const Id type = module_.typeOf(operand);
        if (clean_.count(operand) != 0 || module_.global(module_.scalarOf(type)).opcode() != kOpTypeFloat) {
            return operand;
        }
        return build_.callByComponent(importer_.function("adverseFlush"), type, {operand});
    }

    // Gives the instruction a new result; returns the old one.
    Id rename(Instruction& i)
    {
        const Id old = i.result;
        i.result = i.words[2] = module_.newId();
        if (isFloatArithmetic(i.opcode())) {
            module_.decorate(i.result, kNoContraction);
        }
        return old;
    }

    Id nextSeed() { return module_.constantUint(seed_ == 0 ? 0 : seed_ + 0x9e3779b9U * ++places_); }

    Module& module_;
    Importer importer_;
    Builder build_;
    std::uint32_t seed_, places_ = 0;
    std::set<Id> clean_;
};

}  // namespace

void makeAdverse(Module& module, const Module& library, std::uint32_t seed)
{
    std::vector<Instruction> out;
    Adversary adversary(module, library, seed, out);
    for (Instruction& instruction : module.functions) {
        adversary.replace(std::move(instruction));
    }
    const std::vector<Instruction> imported = adversary.takeFunctions();
    out.insert(out.end(), imported.begin(), imported.end());
    module.functions = std::move(out);
}

}  // namespace glim::spirv
