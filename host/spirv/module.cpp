#include "host/spirv/module.hpp"

#include <spirv-tools/libspirv.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

namespace glim::spirv {
namespace {

constexpr std::size_t kHeaderWords = 5, kBoundAt = 3;

bool isTypeOrConstant(std::uint32_t opcode) { return opcode >= 19 && opcode <= 46; }            // OpTypeVoid to OpConstantNull
bool isGlobal(std::uint32_t opcode) { return (opcode >= 19 && opcode <= 52) || opcode == 59; }  // and OpSpecConstant*, OpVariable

struct Parsed {
    Words header;
    std::vector<Instruction> instructions;
};

spv_result_t keepHeader(void* parsed, spv_endianness_t, std::uint32_t magic, std::uint32_t version, std::uint32_t generator,
                        std::uint32_t bound, std::uint32_t schema)
{
    static_cast<Parsed*>(parsed)->header = {magic, version, generator, bound, schema};
    return SPV_SUCCESS;
}

spv_result_t keepInstruction(void* parsed, const spv_parsed_instruction_t* given)
{
    Instruction instruction;
    instruction.words.assign(given->words, given->words + given->num_words);
    instruction.type = given->type_id;
    instruction.result = given->result_id;
    for (std::uint16_t i = 0; i < given->num_operands; ++i) {
        switch (given->operands[i].type) {
        case SPV_OPERAND_TYPE_ID:
        case SPV_OPERAND_TYPE_TYPE_ID:
        case SPV_OPERAND_TYPE_RESULT_ID:
        case SPV_OPERAND_TYPE_MEMORY_SEMANTICS_ID:
        case SPV_OPERAND_TYPE_SCOPE_ID: instruction.idAt.push_back(given->operands[i].offset); break;
        default: break;
        }
    }
    static_cast<Parsed*>(parsed)->instructions.push_back(std::move(instruction));
    return SPV_SUCCESS;
}

Parsed parse(std::span<const std::uint32_t> words)
{
    const std::unique_ptr<spv_context_t, void (*)(spv_context)> context(spvContextCreate(SPV_ENV_VULKAN_1_2), spvContextDestroy);
    Parsed parsed;
    if (spvBinaryParse(context.get(), &parsed, words.data(), words.size(), keepHeader, keepInstruction, nullptr) != SPV_SUCCESS) {
        throw std::runtime_error("not SPIR-V");
    }
    return parsed;
}

// The type, constant or import without its name.
Words describe(const Instruction& instruction)
{
    Words words = instruction.words;
    words[instruction.type == 0 ? 1 : 2] = 0;
    return words;
}

void append(Words& words, const std::vector<Instruction>& instructions)
{
    for (const Instruction& instruction : instructions) {
        words.insert(words.end(), instruction.words.begin(), instruction.words.end());
    }
}

Instruction makeWords(Opcode opcode, std::initializer_list<std::uint32_t> operands)
{
    Instruction instruction;
    instruction.words.push_back(static_cast<std::uint32_t>(operands.size() + 1) << 16U | opcode);
    instruction.words.insert(instruction.words.end(), operands);
    return instruction;
}

}  // namespace

bool isFloatArithmetic(std::uint32_t opcode)
{
    switch (opcode) {
    case kOpFNegate:
    case kOpFAdd:
    case kOpFSub:
    case kOpFMul:
    case kOpFDiv:
    case 140:                   // OpFRem
    case 141:                   // OpFMod
    case kOpVectorTimesScalar:  // 142
    case 143:                   // OpMatrixTimesScalar
    case 144:                   // OpVectorTimesMatrix
    case 145:                   // OpMatrixTimesVector
    case 146:                   // OpMatrixTimesMatrix
    case 147:                   // OpOuterProduct
    case kOpDot: return true;   // 148
    default: return false;
    }
}

Instruction makeInstruction(Opcode opcode, Id type, Id result, std::span<const Id> operands)
{
    Instruction instruction;
    instruction.words = {static_cast<std::uint32_t>(operands.size() + 3) << 16U | opcode, type, result};
    instruction.words.insert(instruction.words.end(), operands.begin(), operands.end());
    for (std::uint16_t i = 1; i < instruction.words.size(); ++i) {
        instruction.idAt.push_back(i);
    }
    instruction.type = type;
    instruction.result = result;
    return instruction;
}

Instruction makeExtract(Id type, Id result, Id composite, std::uint32_t index)
{
    Instruction instruction = makeInstruction(kOpCompositeExtract, type, result, std::vector<Id>{composite, index});
    instruction.idAt.pop_back();
    return instruction;
}

Module::Module(std::span<const std::uint32_t> words)
{
    Parsed parsed = parse(words);
    header_ = std::move(parsed.header);
    bound_ = header_.at(kBoundAt);
    for (Instruction& instruction : parsed.instructions) {
        if (instruction.result != 0) {
            types_[instruction.result] = instruction.type;
        }
        know(instruction);
        const bool inFunction = !functions.empty() || instruction.opcode() == kOpFunction;
        std::vector<Instruction>& list = inFunction                                            ? functions
                                         : isGlobal(instruction.opcode()) || !globals_.empty() ? globals_
                                                                                               : preamble_;
        list.push_back(std::move(instruction));
    }
}

void Module::know(const Instruction& instruction)
{
    if (isTypeOrConstant(instruction.opcode()) || instruction.opcode() == kOpExtInstImport) {
        known_.emplace(describe(instruction), instruction.result);
    }
}

Words Module::assemble() const
{
    Words words = header_;
    words[kBoundAt] = bound_;
    append(words, preamble_);
    append(words, globals_);
    append(words, functions);
    return words;
}

Id Module::importGlsl()
{
    constexpr char name[] = "GLSL.std.450\0\0\0";  // whole words
    Instruction import = makeWords(kOpExtInstImport, {0, 0, 0, 0, 0});
    std::memcpy(&import.words[2], name, sizeof name);
    return findOrAdd(std::move(import));
}

const Instruction& Module::global(Id id) const
{
    for (const std::vector<Instruction>* list : {&globals_, &preamble_}) {
        const auto found = std::find_if(list->begin(), list->end(), [id](const Instruction& i) { return i.result == id; });
        if (found != list->end()) {
            return *found;
        }
    }
    throw std::runtime_error("SPIR-V has no global with id " + std::to_string(id));
}

std::uint32_t Module::componentsOf(Id type) const
{
    const Instruction& declared = global(type);
    return declared.opcode() == kOpTypeVector ? declared.words[3] : 1;
}

Id Module::scalarOf(Id type) const
{
    const Instruction& declared = global(type);
    return declared.opcode() == kOpTypeVector ? declared.words[2] : type;
}

Id Module::findOrAdd(Instruction instruction)
{
    const auto [known, isNew] = known_.emplace(describe(instruction), bound_);
    if (isNew) {
        instruction.result = newId();
        instruction.words[instruction.type == 0 ? 1 : 2] = instruction.result;
        types_[instruction.result] = instruction.type;
        if (instruction.opcode() == kOpExtInstImport) {
            const auto memoryModel =
                std::find_if(preamble_.begin(), preamble_.end(), [](const Instruction& i) { return i.opcode() == 14; });
            preamble_.insert(memoryModel, std::move(instruction));
        } else {
            globals_.push_back(std::move(instruction));
        }
    }
    return known->second;
}

Id Module::constant(Id type, float value)
{
    if (const std::uint32_t count = componentsOf(type); count > 1) {
        const std::vector<Id> components(count, constant(scalarOf(type), value));
        return findOrAdd(makeInstruction(kOpConstantComposite, type, 0, components));
    }
    Instruction instruction = makeInstruction(kOpConstant, type, 0, std::vector<Id>{std::bit_cast<std::uint32_t>(value)});
    instruction.idAt.pop_back();
    return findOrAdd(std::move(instruction));
}

Id Module::constantUint(std::uint32_t value)
{
    Instruction type = makeWords(kOpTypeInt, {0, 32, 0});
    type.idAt = {1};
    Instruction instruction = makeInstruction(kOpConstant, findOrAdd(std::move(type)), 0, std::vector<Id>{value});
    instruction.idAt.pop_back();
    return findOrAdd(std::move(instruction));
}

void Module::decorate(Id target, std::uint32_t decoration) { preamble_.push_back(makeWords(kOpDecorate, {target, decoration})); }

void Module::addCapability(std::uint32_t capability) { preamble_.insert(preamble_.begin(), makeWords(kOpCapability, {capability})); }

void Module::addExecutionMode(std::uint32_t mode, std::uint32_t operand)
{
    const auto entry = std::find_if(preamble_.begin(), preamble_.end(), [](const Instruction& i) { return i.opcode() == kOpEntryPoint; });
    const Id function = entry->words[2];
    preamble_.insert(entry + 1, makeWords(kOpExecutionMode, {function, mode, operand}));
}

std::span<const Instruction> Module::bodyOf(Id function) const
{
    const auto begin = std::find_if(functions.begin(), functions.end(),
                                    [function](const Instruction& i) { return i.opcode() == kOpFunction && i.result == function; });
    const auto end = std::find_if(begin, functions.end(), [](const Instruction& i) { return i.opcode() == kOpFunctionEnd; });
    return end == functions.end() ? std::span<const Instruction>() : std::span<const Instruction>(begin, end + 1);
}

std::span<const Instruction> Module::findFunction(std::string_view name) const
{
    const std::string wanted = std::string(name) + "(";  // the types of the parameters follow
    for (const Instruction& instruction : preamble_) {
        if (instruction.opcode() == kOpName &&
            std::strncmp(reinterpret_cast<const char*>(&instruction.words[2]), wanted.c_str(), wanted.size()) == 0) {
            return bodyOf(instruction.words[1]);
        }
    }
    throw std::runtime_error("SPIR-V has no function " + std::string(name));
}

}  // namespace glim::spirv
