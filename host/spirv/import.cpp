#include "host/spirv/import.hpp"

namespace glim::spirv {

Id Importer::function(std::string_view name)
{
    const std::span<const Instruction> body = library_.findFunction(name);
    const auto known = ids_.find(body.front().result);
    return known != ids_.end() ? known->second : copy(body);
}

Id Importer::copy(std::span<const Instruction> body)
{
    for (const Instruction& instruction : body) {
        if (instruction.result != 0) {
            ids_[instruction.result] = module_.newId();
        }
    }
    std::vector<Instruction> copied(body.begin(), body.end());
    for (Instruction& instruction : copied) {
        for (const std::uint16_t at : instruction.idAt) {
            instruction.words[at] = find(instruction.words[at]);
        }
        instruction.type = instruction.type == 0 ? 0 : find(instruction.type);
        instruction.result = instruction.result == 0 ? 0 : ids_.at(instruction.result);
        module_.setType(instruction.result, instruction.type);
        if (isFloatArithmetic(instruction.opcode())) {
            module_.decorate(instruction.result, kNoContraction);
        }
    }
    functions_.insert(functions_.end(), copied.begin(), copied.end());
    return copied.front().result;
}

// A function, or a type, constant or import with all that it names.
Id Importer::find(Id id)
{
    if (const auto known = ids_.find(id); known != ids_.end()) {
        return known->second;
    }
    if (const std::span<const Instruction> body = library_.bodyOf(id); !body.empty()) {
        return copy(body);
    }
    Instruction global = library_.global(id);
    for (const std::uint16_t at : global.idAt) {
        if (global.words[at] != id) {
            global.words[at] = find(global.words[at]);
        }
    }
    global.type = global.type == 0 ? 0 : find(global.type);
    return ids_[id] = module_.findOrAdd(std::move(global));
}

}  // namespace glim::spirv
