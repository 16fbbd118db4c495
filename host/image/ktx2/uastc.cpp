#include "host/image/ktx2/uastc.hpp"

#include <algorithm>
#include <cstring>

namespace glim {
namespace {

// How whole numbers below `levels` are stored: `bits` each, and above them digits of base 3 or 5. Section "UASTC BISE Endpoint Ranges
// Table".
struct Range {
    std::uint16_t levels;
    std::uint8_t bits, base;  // base 1: no digits
};
enum RangeName : std::uint8_t { k12, k16, k32, k40, k48, k160, k192, k256 };
constexpr Range kRanges[] = {{12, 2, 3}, {16, 4, 1}, {32, 5, 1}, {40, 3, 5}, {48, 4, 3}, {160, 5, 5}, {192, 6, 3}, {256, 8, 1}};

// Digits share a number: five of base 3 take 8 bits, three of base 5 take 7, and fewer take as few as they can (section "Field
// Definitions", ETQ).
constexpr std::uint8_t kBitsOfTrits[] = {0, 2, 4, 5, 7, 8}, kBitsOfQuints[] = {0, 3, 5, 7};

// Section "List of UASTC Modes". `start`: of the fields behind the hints for transcoders.
struct Mode {
    std::uint8_t start, subsets, planes, components, weightBits;
    RangeName endpoints;
};
constexpr std::size_t kSolid = 8, kModes = 19;
constexpr Mode kModeTable[kModes] = {
    {19, 1, 1, 3, 4, k192}, {21, 1, 1, 3, 2, k256}, {20, 2, 1, 3, 3, k16},  {20, 3, 1, 3, 2, k12},  {20, 2, 1, 3, 2, k40},
    {20, 1, 1, 3, 3, k256}, {20, 1, 2, 3, 2, k160}, {20, 2, 1, 3, 2, k40},  {5, 0, 0, 4, 0, k256},  {28, 2, 1, 4, 2, k16},
    {20, 1, 1, 4, 4, k48},  {19, 1, 2, 4, 2, k48},  {20, 1, 1, 4, 3, k192}, {28, 1, 2, 4, 1, k256}, {28, 1, 1, 4, 2, k256},
    {30, 1, 1, 2, 4, k256}, {29, 2, 1, 2, 2, k256}, {29, 1, 2, 2, 2, k256}, {19, 1, 1, 3, 5, k32},
};

// By the lowest seven bits of a block: the codes of section "Field Definitions", MODE. 19 is reserved.
struct Code {
    std::uint8_t bits, length;
};
constexpr Code kModeCodes[kModes + 1] = {{0x01, 4}, {0x35, 6}, {0x1d, 5}, {0x03, 5}, {0x13, 5}, {0x0b, 5}, {0x1b, 5},
                                         {0x07, 5}, {0x17, 5}, {0x0f, 5}, {0x02, 3}, {0x00, 2}, {0x06, 3}, {0x1f, 5},
                                         {0x0d, 5}, {0x05, 7}, {0x15, 6}, {0x25, 6}, {0x09, 4}, {0x45, 7}};

constexpr std::array<std::uint8_t, 128> listModes()
{
    std::array<std::uint8_t, 128> modes{};
    for (std::size_t i = 0; i < modes.size(); ++i) {
        for (std::uint8_t mode = 0; mode <= kModes; ++mode) {
            if ((i & ((1U << kModeCodes[mode].length) - 1)) == kModeCodes[mode].bits) {
                modes[i] = mode;
            }
        }
    }
    return modes;
}
constexpr std::array<std::uint8_t, 128> kModeOf = listModes();

// Which subset each texel belongs to, two bits per texel, the first one lowest. They are partitions of ASTC that BC7 has too; the sections
// "UASTC/BC7 2-Subset", "3-Subset" and "2-Subset ASTC 3-Subset BC7 Partition Pattern Table" list their seeds.
constexpr std::uint32_t kPatterns2[] = {0x50505050, 0x40404040, 0x01010101, 0x54505040, 0x05151555, 0x55545450, 0x00010515, 0x01051555,
                                        0x50400000, 0x00000105, 0x55544000, 0x01155555, 0x00000115, 0x00005555, 0x55555500, 0x00555555,
                                        0x55551501, 0x40545555, 0x00405054, 0x00004050, 0x15050100, 0x50545555, 0x15050501, 0x00404050,
                                        0x50545455, 0x14141414, 0x55000055, 0x11111111, 0x00550055, 0x05145041};
constexpr std::uint32_t kPatterns3[] = {0xa5a50000, 0xaa005555, 0xaa000055, 0x0000aa55, 0x25252525, 0x94949494,
                                        0x58585858, 0x56560202, 0x92929292, 0x55aa0055, 0xa05050a0};
constexpr std::uint32_t kPatternsOfMode7[] = {0x00005500, 0x10101010, 0x00010505, 0x50504000, 0x55005555, 0x04040404, 0x55555040,
                                              0x50505054, 0x05500005, 0x00005454, 0x15150000, 0x05000005, 0x00005054, 0x55554000,
                                              0x14555555, 0x01050505, 0x01015555, 0x01051450, 0x00005455};

struct PatternList {
    std::span<const std::uint32_t> patterns;
    unsigned bits;  // of an index
};

PatternList patternsOf(std::size_t mode)
{
    return mode == 7                       ? PatternList{kPatternsOfMode7, 5}
           : kModeTable[mode].subsets == 3 ? PatternList{kPatterns3, 4}
                                           : PatternList{kPatterns2, 5};
}

// The weights of the second endpoint, in 1/64, by the bits of their index: section "UASTC Weight Tables".
constexpr std::uint8_t kWeights1[] = {0, 64}, kWeights2[] = {0, 21, 43, 64}, kWeights3[] = {0, 9, 18, 27, 37, 46, 55, 64};
constexpr std::uint8_t kWeights4[] = {0, 4, 8, 12, 17, 21, 25, 29, 35, 39, 43, 47, 52, 56, 60, 64};
constexpr std::uint8_t kWeights5[] = {0,  2,  4,  6,  8,  10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30,
                                      34, 36, 38, 40, 42, 44, 46, 48, 50, 52, 54, 56, 58, 60, 62, 64};
constexpr const std::uint8_t* kWeights[] = {nullptr, kWeights1, kWeights2, kWeights3, kWeights4, kWeights5};

// Khronos Data Format Specification 1.3, section "Endpoint Unquantization" of ASTC: its table of B and C.
constexpr std::uint8_t dequantize(const Range& range, unsigned value)
{
    if (range.base == 1) {
        const unsigned high = value << (8U - range.bits);
        return static_cast<std::uint8_t>(high | high >> range.bits);
    }
    const unsigned digit = value >> range.bits, lowest = value & 1U ? 0x1ffU : 0U;
    const unsigned x = (value & ((1U << range.bits) - 1)) >> 1U;
    unsigned b = 0, c = 0;
    switch (range.levels) {
    case 12: b = x << 8U | x << 4U | x << 2U | x << 1U, c = 93; break;
    case 40: b = x << 7U | x << 1U | x >> 1U, c = 26; break;
    case 48: b = x << 6U | x, c = 22; break;
    case 160: b = x << 5U | x >> 3U, c = 6; break;
    default: b = x << 4U | x >> 4U, c = 5;
    }
    const unsigned sum = (digit * c + b) ^ lowest;
    return static_cast<std::uint8_t>((lowest & 0x80U) | sum >> 2U);
}

constexpr std::array<std::array<std::uint8_t, 256>, std::size(kRanges)> listLevels()
{
    std::array<std::array<std::uint8_t, 256>, std::size(kRanges)> levels{};
    for (std::size_t range = 0; range < levels.size(); ++range) {
        for (unsigned value = 0; value < 256; ++value) {
            levels[range][value] = dequantize(kRanges[range], value);
        }
    }
    return levels;
}
constexpr auto kLevels = listLevels();

// The first bit is the lowest of the first byte.
class BlockBits {
public:
    explicit BlockBits(std::span<const unsigned char, kUastcBlockBytes> block)
    {
        std::memcpy(&low_, block.data(), sizeof low_);
        std::memcpy(&high_, block.data() + sizeof low_, sizeof high_);
    }
    // At most 63 bits at a time.
    std::uint32_t take(unsigned count)
    {
        const std::uint64_t value = low_ & ((std::uint64_t{1} << count) - 1);
        low_ = low_ >> count | high_ << 1U << (63U - count);
        high_ >>= count;
        return static_cast<std::uint32_t>(value);
    }

private:
    std::uint64_t low_, high_;
};

// Section "Field Definitions", ETQ and EBITS: the digits of all values, then the bits of each.
constexpr std::size_t kMaxValues = 18;
void readEndpoints(BlockBits& bits, RangeName name, std::size_t count, std::array<std::uint8_t, kMaxValues>& values)
{
    const Range& range = kRanges[name];
    std::array<unsigned, kMaxValues> digits{};
    const std::size_t group = range.base == 3 ? 5 : 3;
    for (std::size_t i = 0; range.base != 1 && i < count; i += group) {
        const std::size_t held = std::min(group, count - i);
        std::uint32_t packed = bits.take(range.base == 3 ? kBitsOfTrits[held] : kBitsOfQuints[held]);
        for (std::size_t k = 0; k < held; ++k) {
            digits[i + k] = packed % range.base;
            packed /= range.base;
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        values[i] = kLevels[name][digits[i] << range.bits | bits.take(range.bits)];
    }
}

// Section "UASTC Endpoint Interpolation". Reference encoders have minimized the error of this form, also of textures that hold sRGB.
std::uint8_t interpolate(std::uint32_t first, std::uint32_t second, std::uint32_t weight)
{
    return static_cast<std::uint8_t>((first * 257 * (64 - weight) + second * 257 * weight + 32) >> 14U);
}

}  // namespace

bool decodeUastc(std::span<const unsigned char, kUastcBlockBytes> block, UastcTexels& texels)
{
    const std::size_t number = kModeOf[block[0] & 127U];
    if (number == kModes) {
        return false;
    }
    const Mode& mode = kModeTable[number];
    BlockBits bits(block);
    bits.take(mode.start);
    if (number == kSolid) {
        std::array<std::uint8_t, 4> color;
        for (std::uint8_t& channel : color) {
            channel = static_cast<std::uint8_t>(bits.take(8));
        }
        texels.fill(color);
        return true;
    }
    std::uint32_t pattern = 0;
    if (mode.subsets > 1) {
        const PatternList list = patternsOf(number);
        const std::uint32_t index = bits.take(list.bits);
        if (index >= list.patterns.size()) {
            return false;
        }
        pattern = list.patterns[index];
    }
    // Which channel the second plane's weights are for; of luminance and alpha it is alpha.
    constexpr std::size_t kAlpha = 3;
    const std::size_t apart = mode.planes == 1 || mode.components == 2 ? kAlpha : bits.take(2);
    std::array<std::uint8_t, kMaxValues> values;
    readEndpoints(bits, mode.endpoints, std::size_t{2} * mode.components * mode.subsets, values);
    std::array<std::array<std::uint8_t, 8>, 3> ends;  // of each subset: R, R, G, G, B, B, A, A
    for (std::size_t s = 0; s < mode.subsets; ++s) {
        const std::uint8_t* const of = &values[s * 2 * mode.components];
        ends[s] = mode.components == 2   ? std::array<std::uint8_t, 8>{of[0], of[1], of[0], of[1], of[0], of[1], of[2], of[3]}
                  : mode.components == 3 ? std::array<std::uint8_t, 8>{of[0], of[1], of[2], of[3], of[4], of[5], 255, 255}
                                         : std::array<std::uint8_t, 8>{of[0], of[1], of[2], of[3], of[4], of[5], of[6], of[7]};
    }
    // The highest bit of the first index of each subset is 0 and left out (section "UASTC Partition Pattern Anchor Index Tables").
    unsigned begun = 0;
    for (UastcTexels::value_type& texel : texels) {
        const unsigned subset = pattern & 3U, bit = 1U << subset;
        pattern >>= 2U;
        const unsigned length = mode.weightBits - ((begun & bit) == 0 ? 1U : 0U);
        begun |= bit;
        const std::uint32_t weight = kWeights[mode.weightBits][bits.take(length)];
        const std::uint32_t weightApart = mode.planes == 2 ? kWeights[mode.weightBits][bits.take(length)] : weight;
        const std::array<std::uint8_t, 8>& of = ends[subset];
        for (std::size_t c = 0; c < 4; ++c) {
            texel[c] = interpolate(of[2 * c], of[2 * c + 1], c == apart ? weightApart : weight);
        }
    }
    return true;
}

}  // namespace glim
