#include "host/image/ktx2/huffman.hpp"

#include "host/image/ktx2/refuse_ktx2.hpp"

#include <algorithm>

namespace glim {
namespace {

// In the order in which a table sends the lengths of the codes of code lengths.
constexpr std::uint8_t kLengthOrder[] = {17, 18, 19, 20, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15, 16};

// Symbols of code lengths above the lengths themselves: runs of zeros, or of the length before.
struct Run {
    bool repeats;
    unsigned bits, shortest;
};
constexpr Run kRuns[] = {{false, 3, 3}, {false, 7, 11}, {true, 2, 3}, {true, 7, 7}};

std::uint32_t reversed(std::uint32_t code, unsigned length)
{
    std::uint32_t result = 0;
    for (unsigned i = 0; i < length; ++i) {
        result |= (code >> i & 1U) << (length - 1 - i);
    }
    return result;
}

}  // namespace

void BitReader::refuseEnd() const { refuseKtx2(section_ + " has", std::to_string(bytes_.size()) + " bytes", "more"); }

// Codes follow from their lengths as in Deflate (RFC 1951, section 3.2.2).
HuffmanTable::HuffmanTable(std::span<const std::uint8_t> lengths, const std::string& section)
{
    for (const std::uint8_t length : lengths) {
        ++counts_[length];
    }
    const std::uint32_t used = static_cast<std::uint32_t>(lengths.size()) - counts_[0];
    counts_[0] = 0;
    std::array<std::uint32_t, kMaxLength + 2> nextCode{}, nextPlace{};
    std::uint32_t share = 0;  // of all texts that the codes begin, in 1/65536
    for (unsigned length = 1; length <= kMaxLength; ++length) {
        share += counts_[length] << (kMaxLength - length);
        nextCode[length + 1] = (nextCode[length] + counts_[length]) << 1U;
        nextPlace[length + 1] = nextPlace[length] + counts_[length];
    }
    constexpr std::uint32_t kWhole = 1U << kMaxLength;
    if (share > kWhole || (share < kWhole && used != 1)) {
        refuseKtx2("a Huffman table of " + section + " fills", std::to_string(share) + "/65536 of its codes", "65536/65536");
    }
    symbols_.resize(used);
    for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
        const unsigned length = lengths[symbol];
        if (length == 0) {
            continue;
        }
        symbols_[nextPlace[length]++] = static_cast<std::uint16_t>(symbol);
        const std::uint32_t code = reversed(nextCode[length]++, length);
        for (std::uint32_t i = code; length <= kShortLength && i < kShortCodes; i += 1U << length) {
            short_[i] = {static_cast<std::uint16_t>(symbol), static_cast<std::uint8_t>(length)};
        }
    }
}

std::uint32_t HuffmanTable::decodeLong(BitReader& bits) const
{
    const std::uint32_t window = bits.peek(kMaxLength);
    std::uint32_t code = 0, first = 0, place = 0;
    for (unsigned length = 1; length <= kMaxLength; ++length) {
        code = code << 1U | (window >> (length - 1) & 1U);
        if (code - first < counts_[length]) {
            bits.skip(length);
            return symbols_[place + code - first];
        }
        place += counts_[length];
        first = (first + counts_[length]) << 1U;
    }
    refuseKtx2(bits.section() + " has", "bits that are no Huffman code", "one");
}

HuffmanTable readHuffmanTable(BitReader& bits)
{
    const std::uint32_t symbols = bits.read(14);
    if (symbols == 0) {
        return {};  // what encoders write where no symbol is needed
    }
    const std::uint32_t sent = bits.read(5);
    if (sent == 0 || sent > std::size(kLengthOrder)) {
        refuseKtx2("a Huffman table of " + bits.section() + " has", std::to_string(sent) + " lengths of lengths",
                   "1 to " + std::to_string(std::size(kLengthOrder)));
    }
    std::uint8_t lengthLengths[std::size(kLengthOrder)] = {};
    for (std::uint32_t i = 0; i < sent; ++i) {
        lengthLengths[kLengthOrder[i]] = static_cast<std::uint8_t>(bits.read(3));
    }
    const HuffmanTable lengthTable(lengthLengths, bits.section());
    std::vector<std::uint8_t> lengths;
    while (lengths.size() < symbols) {
        const std::uint32_t symbol = lengthTable.decode(bits);
        if (symbol <= HuffmanTable::kMaxLength) {
            lengths.push_back(static_cast<std::uint8_t>(symbol));
            continue;
        }
        const Run& run = kRuns[symbol - HuffmanTable::kMaxLength - 1];
        const std::uint32_t count = bits.read(run.bits) + run.shortest;
        const std::uint8_t repeated = run.repeats && !lengths.empty() ? lengths.back() : 0;
        if ((run.repeats && repeated == 0) || count > symbols - lengths.size()) {
            refuseKtx2("a Huffman table of " + bits.section() + " has",
                       "a run of " + std::to_string(count) + " lengths after " + std::to_string(lengths.size()),
                       "a run within its " + std::to_string(symbols) + (run.repeats ? ", after a length above 0" : ""));
        }
        lengths.insert(lengths.end(), count, repeated);
    }
    return {lengths, bits.section()};
}

}  // namespace glim
