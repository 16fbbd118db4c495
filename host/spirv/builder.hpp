// Instructions appended to a function. The last one of an expression gets the id of the instruction that the expression replaces.
#pragma once

#include "host/spirv/module.hpp"

namespace glim::spirv {

class Builder {
public:
    Builder(Module& module, std::vector<Instruction>& out)
        : module_(module),
          out_(out)
    {}

    Module& module() { return module_; }
    Id append(Instruction instruction);
    // `result` 0 stands for a new id, in what follows too.
    Id operate(Opcode opcode, Id type, const std::vector<Id>& operands, Id result = 0);
    Id extended(ExtendedInstruction number, Id type, const std::vector<Id>& operands, Id result = 0);
    Id extract(Id vector, std::uint32_t index);
    // One call for a scalar; for a vector one for each component, with the components of the operands that are vectors.
    Id callByComponent(Id function, Id type, const std::vector<Id>& operands, Id result = 0);

private:
    Id named(Id result) { return result == 0 ? module_.newId() : result; }
    Id call(Id function, Id type, const std::vector<Id>& operands, Id result);

    Module& module_;
    std::vector<Instruction>& out_;
};

}  // namespace glim::spirv
