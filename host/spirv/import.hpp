// Functions of one module in another one.
#pragma once

#include "host/spirv/module.hpp"

#include <string_view>

namespace glim::spirv {

// Copies functions, and what they call and name, out of a library into a module. Both must outlive it.
class Importer {
public:
    Importer(Module& module, const Module& library)
        : module_(module),
          library_(library)
    {}

    // The copy of the function with this GLSL name, whose parameters must be `const`, so that they are passed by value. It must use no
    // variable outside of functions. Throws std::runtime_error if there is none.
    Id function(std::string_view name);
    // The copies, to be appended to the module's functions when it is not being rewritten.
    std::vector<Instruction> takeFunctions() { return std::move(functions_); }

private:
    Id copy(std::span<const Instruction> body);
    Id find(Id id);

    Module& module_;
    const Module& library_;
    std::map<Id, Id> ids_;  // of the library, in the module
    std::vector<Instruction> functions_;
};

}  // namespace glim::spirv
