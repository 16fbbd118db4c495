// A SPIR-V module as lists of instructions, to be changed and written again. Opcodes and the numbers of enumerants are those of the SPIR-V
// specification, section 3.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace glim::spirv {

using Id = std::uint32_t;
using Words = std::vector<std::uint32_t>;

enum Opcode : std::uint32_t {
    kOpName = 5,
    kOpExtInstImport = 11,
    kOpExtInst = 12,
    kOpEntryPoint = 15,
    kOpExecutionMode = 16,
    kOpCapability = 17,
    kOpTypeInt = 21,
    kOpTypeFloat = 22,
    kOpTypeVector = 23,
    kOpConstant = 43,
    kOpConstantComposite = 44,
    kOpFunction = 54,
    kOpFunctionEnd = 56,
    kOpFunctionCall = 57,
    kOpVariable = 59,
    kOpDecorate = 71,
    kOpMemberDecorate = 72,
    kOpCompositeConstruct = 80,
    kOpCompositeExtract = 81,
    kOpConvertFToU = 109,
    kOpConvertFToS = 110,
    kOpFNegate = 127,
    kOpFAdd = 129,
    kOpFSub = 131,
    kOpFMul = 133,
    kOpFDiv = 136,
    kOpVectorTimesScalar = 142,
    kOpDot = 148,
};

constexpr std::uint32_t kNoContraction = 42;  // a decoration

// Instructions of the set GLSL.std.450, which is the only one that glim imports.
enum ExtendedInstruction : std::uint32_t {
    kGlslFSign = 6,
    kGlslFloor = 8,
    kGlslFract = 10,
    kGlslSin = 13,
    kGlslCos = 14,
    kGlslAsin = 16,
    kGlslAcos = 17,
    kGlslAtan = 18,
    kGlslAtan2 = 25,
    kGlslPow = 26,
    kGlslExp = 27,
    kGlslLog = 28,
    kGlslExp2 = 29,
    kGlslLog2 = 30,
    kGlslSqrt = 31,
    kGlslInverseSqrt = 32,
    kGlslFMin = 37,
    kGlslFMax = 40,
    kGlslFClamp = 43,
    kGlslFMix = 46,
    kGlslFma = 50,
    kGlslLength = 66,
    kGlslDistance = 67,
    kGlslCross = 68,
    kGlslNormalize = 69,
};

struct Instruction {
    Words words;                      // the first has length and opcode
    std::vector<std::uint16_t> idAt;  // which of the words are ids
    Id type = 0, result = 0;          // 0: none

    std::uint32_t opcode() const { return words[0] & 0xffff; }
    bool isExtended(std::uint32_t number) const { return opcode() == kOpExtInst && words[4] == number; }
};

// Whether a driver may contract or reassociate it unless it is decorated NoContraction.
bool isFloatArithmetic(std::uint32_t opcode);

// An instruction with a type and a result, all of whose operands are ids.
Instruction makeInstruction(Opcode opcode, Id type, Id result, std::span<const Id> operands);
Instruction makeExtract(Id type, Id result, Id composite, std::uint32_t index);

class Module {
public:
    // Throws std::runtime_error if `words` are not SPIR-V.
    explicit Module(std::span<const std::uint32_t> words);

    Words assemble() const;

    Id newId() { return bound_++; }
    Id typeOf(Id result) const { return types_.at(result); }
    void setType(Id result, Id type) { types_[result] = type; }
    // The import of GLSL.std.450.
    Id importGlsl();
    // The components of a vector type; 1 of any other.
    std::uint32_t componentsOf(Id type) const;
    // The type of a vector's components; of any other type itself.
    Id scalarOf(Id type) const;
    // The type, constant or import that is this instruction but for its result. It is added if the module lacks it.
    Id findOrAdd(Instruction instruction);
    // The constant of float type `type`, or all components of which have the value.
    Id constant(Id type, float value);
    Id constantUint(std::uint32_t value);
    // Puts a decoration, a capability or an execution mode where it belongs.
    void decorate(Id target, std::uint32_t decoration);
    void addCapability(std::uint32_t capability);
    void addExecutionMode(std::uint32_t mode, std::uint32_t operand);
    // The instructions from OpFunction to OpFunctionEnd. The span is empty if no function has this id.
    std::span<const Instruction> bodyOf(Id function) const;
    // Of the function with this GLSL name. Throws std::runtime_error if there is none.
    std::span<const Instruction> findFunction(std::string_view name) const;
    // The type, constant, variable or import with this id.
    const Instruction& global(Id id) const;
    std::span<const Instruction> globals() const { return globals_; }
    // From capabilities to decorations.
    std::span<const Instruction> preamble() const { return preamble_; }

    std::vector<Instruction> functions;  // their bodies, in order

private:
    void know(const Instruction& instruction);

    Words header_;
    std::uint32_t bound_ = 0;
    std::vector<Instruction> preamble_;
    std::vector<Instruction> globals_;  // types, constants, variables
    std::unordered_map<Id, Id> types_;  // by result
    std::map<Words, Id> known_;         // types, constants and imports by their words with 0 for the result
};

}  // namespace glim::spirv
