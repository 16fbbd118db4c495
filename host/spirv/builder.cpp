#include "host/spirv/builder.hpp"

namespace glim::spirv {

Id Builder::append(Instruction instruction)
{
    const Id result = instruction.result;
    module_.setType(result, instruction.type);
    out_.push_back(std::move(instruction));
    return result;
}

Id Builder::operate(Opcode opcode, Id type, const std::vector<Id>& operands, Id result)
{
    return append(makeInstruction(opcode, type, named(result), operands));
}

Id Builder::extended(ExtendedInstruction number, Id type, const std::vector<Id>& operands, Id result)
{
    std::vector<Id> all{module_.importGlsl(), number};
    all.insert(all.end(), operands.begin(), operands.end());
    Instruction instruction = makeInstruction(kOpExtInst, type, named(result), all);
    instruction.idAt.erase(instruction.idAt.begin() + 3);  // the number
    return append(std::move(instruction));
}

Id Builder::extract(Id vector, std::uint32_t index)
{
    return append(makeExtract(module_.scalarOf(module_.typeOf(vector)), module_.newId(), vector, index));
}

Id Builder::call(Id function, Id type, const std::vector<Id>& operands, Id result)
{
    std::vector<Id> all{function};
    all.insert(all.end(), operands.begin(), operands.end());
    return operate(kOpFunctionCall, type, all, result);
}

Id Builder::callByComponent(Id function, Id type, const std::vector<Id>& operands, Id result)
{
    const std::uint32_t count = module_.componentsOf(type);
    if (count == 1) {
        return call(function, type, operands, result);
    }
    std::vector<Id> components;
    for (std::uint32_t i = 0; i < count; ++i) {
        std::vector<Id> scalars = operands;
        for (Id& operand : scalars) {
            operand = module_.componentsOf(module_.typeOf(operand)) == 1 ? operand : extract(operand, i);
        }
        components.push_back(call(function, module_.scalarOf(type), scalars, 0));
    }
    return operate(kOpCompositeConstruct, type, components, result);
}

}  // namespace glim::spirv
