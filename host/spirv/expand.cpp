#include "host/spirv/expand.hpp"

#include "host/spirv/builder.hpp"

#include <algorithm>
#include <unordered_map>

namespace glim::spirv {
namespace {

Id dot(Builder& build, Id a, Id b, Id result = 0)
{
    const Id vector = build.module().typeOf(a), scalar = build.module().scalarOf(vector);
    const std::uint32_t count = build.module().componentsOf(vector);
    Id sum = build.operate(kOpFMul, scalar, {build.extract(a, 0), build.extract(b, 0)});
    for (std::uint32_t i = 1; i < count; ++i) {
        const Id product = build.operate(kOpFMul, scalar, {build.extract(a, i), build.extract(b, i)});
        sum = build.operate(kOpFAdd, scalar, {sum, product}, i + 1 == count ? result : 0);
    }
    return sum;
}

Id length(Builder& build, Id v, Id result = 0)
{
    const Id scalar = build.module().scalarOf(build.module().typeOf(v));
    return build.extended(kGlslSqrt, scalar, {dot(build, v, v)}, result);
}

void cross(Builder& build, Id a, Id b, Id type, Id result)
{
    const Id scalar = build.module().scalarOf(type);
    std::vector<Id> components;
    for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t j = (i + 1) % 3, k = (i + 2) % 3;
        const Id first = build.operate(kOpFMul, scalar, {build.extract(a, j), build.extract(b, k)});
        const Id second = build.operate(kOpFMul, scalar, {build.extract(b, j), build.extract(a, k)});
        components.push_back(build.operate(kOpFSub, scalar, {first, second}));
    }
    build.operate(kOpCompositeConstruct, type, components, result);
}

void mix(Builder& build, Id x, Id y, Id a, Id type, Id result)
{
    const Id rest = build.operate(kOpFSub, type, {build.module().constant(type, 1.0F), a});
    const Id first = build.operate(kOpFMul, type, {x, rest});
    build.operate(kOpFAdd, type, {first, build.operate(kOpFMul, type, {y, a})}, result);
}

void divide(Builder& build, Id v, Id divisor, Id type, Id result)
{
    const Id scalar = build.module().scalarOf(type);
    const Id inverse = build.operate(kOpFDiv, scalar, {build.module().constant(scalar, 1.0F), divisor});
    build.operate(kOpVectorTimesScalar, type, {v, inverse}, result);
}

// Ids of vectors all of whose components are one number, and the number's.
using Splats = std::unordered_map<Id, Id>;

void noteSplat(Splats& splats, const Instruction& i)
{
    if (i.opcode() == kOpCompositeConstruct && std::all_of(i.words.begin() + 4, i.words.end(), [&i](Id id) { return id == i.words[3]; })) {
        splats[i.result] = i.words[3];
    }
}

// Appends what replaces the instruction; false if nothing does.
bool replace(Builder& build, const Splats& splats, const Instruction& i)
{
    if (i.opcode() == kOpFDiv && splats.contains(i.words[4])) {
        divide(build, i.words[3], splats.at(i.words[4]), i.type, i.result);
        return true;
    }
    if (i.opcode() == kOpDot) {
        dot(build, i.words[3], i.words[4], i.result);
        return true;
    }
    if (i.opcode() != kOpExtInst) {
        return false;
    }
    const auto operand = [&i](std::size_t k) { return i.words.at(5 + k); };
    switch (i.words[4]) {
    case kGlslFract: build.operate(kOpFSub, i.type, {operand(0), build.extended(kGlslFloor, i.type, {operand(0)})}, i.result); return true;
    case kGlslFClamp:
        build.extended(kGlslFMin, i.type, {build.extended(kGlslFMax, i.type, {operand(0), operand(1)}), operand(2)}, i.result);
        return true;
    case kGlslFMix: mix(build, operand(0), operand(1), operand(2), i.type, i.result); return true;
    case kGlslLength: length(build, operand(0), i.result); return true;
    case kGlslDistance:
        length(build, build.operate(kOpFSub, build.module().typeOf(operand(0)), {operand(0), operand(1)}), i.result);
        return true;
    case kGlslCross: cross(build, operand(0), operand(1), i.type, i.result); return true;
    case kGlslNormalize: divide(build, operand(0), length(build, operand(0)), i.type, i.result); return true;
    default: return false;
    }
}

}  // namespace

void expand(Module& module)
{
    std::vector<Instruction> out;
    Builder build(module, out);
    Splats splats;
    for (Instruction& instruction : module.functions) {
        noteSplat(splats, instruction);
        if (!replace(build, splats, instruction)) {
            out.push_back(std::move(instruction));
        }
    }
    module.functions = std::move(out);
}

}  // namespace glim::spirv
