// mark_floats IN.spv OUT.spv: decorates the result of every float arithmetic instruction NoContraction, and declares that
// signed zeros, infinities and NaN are kept: kernels let distances be infinite and guard against NaN by comparisons.
//
// Vulkan lets a driver contract and reassociate undecorated float operations. GLSL's `precise` does the same job but
// does not reach into called functions, cross() or dot(). With every operation marked, kernels with and without a
// feature, in both schedules and on both versions of the software driver compute the same bits; measured cost there: none.
//
// It also refuses OpExtInst Fma: `fma` may be unfused, so nothing may rest on it.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace {

// Opcodes and the other numbers are those of the SPIR-V specification, sections 3.6, 3.20, 3.31 and 3.49.
constexpr std::uint32_t kMagic = 0x07230203;
constexpr std::uint32_t kOpExtInst = 12, kOpEntryPoint = 15, kOpExecutionMode = 16, kOpCapability = 17, kOpDecorate = 71;
constexpr std::uint32_t kNoContraction = 42, kGlslFma = 50;
constexpr std::uint32_t kSignedZeroInfNanPreserveCapability = 4466, kSignedZeroInfNanPreserve = 4461;
constexpr std::size_t kHeaderWords = 5;
const std::set<std::uint32_t> kFloatArithmetic = {
    127,                      // OpFNegate
    129, 131, 133, 136,       // OpFAdd, OpFSub, OpFMul, OpFDiv
    140, 141,                 // OpFRem, OpFMod
    142, 143, 144, 145, 146,  // OpVectorTimesScalar, OpMatrixTimesScalar, OpVectorTimesMatrix, OpMatrixTimesVector, ...
    147, 148,                 // OpOuterProduct, OpDot
};

// Types begin at the first OpType*; decorations must come before them.
bool isType(std::uint32_t opcode) { return opcode >= 19 && opcode <= 39; }  // OpTypeVoid .. OpTypeForwardPointer

std::vector<std::uint32_t> readWords(const char* path)
{
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    std::vector<std::uint32_t> words(bytes.size() / 4);
    bytes.copy(reinterpret_cast<char*>(words.data()), words.size() * 4);
    return words;
}

// Where things belong in a module, and what it lacks.
struct Findings {
    std::uint32_t entry = 0;                   // the entry point's id
    std::size_t entryEnd = 0, typesBegin = 0;  // execution modes go to the one, decorations to the other
    std::vector<std::uint32_t> decorations;
    bool usesFma = false;
};

Findings examine(const std::vector<std::uint32_t>& words)
{
    Findings found;
    std::set<std::uint32_t> marked;
    for (std::size_t at = kHeaderWords; at < words.size(); at += words[at] >> 16) {
        const std::uint32_t opcode = words[at] & 0xffff;
        if (found.typesBegin == 0 && isType(opcode)) {
            found.typesBegin = at;
        }
        if (opcode == kOpEntryPoint) {
            found.entry = words[at + 2];
            found.entryEnd = at + (words[at] >> 16);
        }
        if (opcode == kOpDecorate && words[at + 2] == kNoContraction) {
            marked.insert(words[at + 1]);
        }
        found.usesFma = found.usesFma || (opcode == kOpExtInst && words[at + 4] == kGlslFma);
        if (kFloatArithmetic.count(opcode) != 0 && marked.count(words[at + 2]) == 0) {
            found.decorations.insert(found.decorations.end(), {(3U << 16) | kOpDecorate, words[at + 2], kNoContraction});
        }
    }
    return found;
}

bool writeMarked(const char* path, const std::vector<std::uint32_t>& words, const Findings& found)
{
    const std::vector<std::uint32_t> capability{(2U << 16) | kOpCapability, kSignedZeroInfNanPreserveCapability};
    const std::vector<std::uint32_t> mode{(4U << 16) | kOpExecutionMode, found.entry, kSignedZeroInfNanPreserve, 32};
    std::ofstream out(path, std::ios::binary);
    const auto write = [&out](const std::uint32_t* begin, std::size_t count) {
        out.write(reinterpret_cast<const char*>(begin), static_cast<std::streamsize>(count * 4));
    };
    write(words.data(), kHeaderWords);
    write(capability.data(), capability.size());
    write(words.data() + kHeaderWords, found.entryEnd - kHeaderWords);
    write(mode.data(), mode.size());
    write(words.data() + found.entryEnd, found.typesBegin - found.entryEnd);
    write(found.decorations.data(), found.decorations.size());
    write(words.data() + found.typesBegin, words.size() - found.typesBegin);
    return out.good();
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 3) {
        std::fprintf(stderr, "usage: mark_floats IN.spv OUT.spv\n");
        return 2;
    }
    const std::vector<std::uint32_t> words = readWords(argv[1]);
    if (words.size() < kHeaderWords || words[0] != kMagic) {
        std::fprintf(stderr, "%s: not SPIR-V\n", argv[1]);
        return 1;
    }
    const Findings found = examine(words);
    if (found.usesFma) {
        std::fprintf(stderr, "%s: uses fma(), which a driver may leave unfused\n", argv[1]);
        return 1;
    }
    return writeMarked(argv[2], words, found) ? 0 : 1;
}
