// Bits and Huffman codes of BasisLZ: KTX 2.0 specification, "BasisLZ/ETC1S Bitstream Specification", section "Compressed Huffman Tables".
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace glim {

static_assert(std::endian::native == std::endian::little, "the fields of KTX2 are read as they lie in memory");

// The first bit is the lowest of the first byte. Refuses to read past the end; `section` names the bytes in the sentence, as "its
// first slice".
class BitReader {
public:
    BitReader(std::span<const unsigned char> bytes, std::string section)
        : bytes_(bytes),
          section_(std::move(section))
    {}

    // At most 32 bits; those past the end are 0.
    std::uint32_t peek(unsigned count)
    {
        if (held_ < count) {
            fill();
        }
        return static_cast<std::uint32_t>(window_ & ((std::uint64_t{1} << count) - 1));
    }
    // Bits that were looked at.
    void skip(unsigned count)
    {
        if (count > held_) {
            refuseEnd();
        }
        window_ >>= count;
        held_ -= count;
    }
    std::uint32_t read(unsigned count)
    {
        const std::uint32_t value = peek(count);
        skip(count);
        return value;
    }
    const std::string& section() const { return section_; }

private:
    void fill()
    {
        for (; held_ <= 56 && next_ < bytes_.size(); held_ += 8) {
            window_ |= std::uint64_t{bytes_[next_++]} << held_;
        }
    }
    [[noreturn]] void refuseEnd() const;

    std::span<const unsigned char> bytes_;
    std::string section_;
    std::size_t next_ = 0;
    std::uint64_t window_ = 0;  // the next bits; those above `held_` are 0
    unsigned held_ = 0;
};

class HuffmanTable {
public:
    HuffmanTable() = default;  // without a symbol: decoding refuses
    // Lengths of the symbols' codes, 0 for those without one; `section` is for the sentence if the lengths are no code.
    HuffmanTable(std::span<const std::uint8_t> lengths, const std::string& section);

    std::uint32_t decode(BitReader& bits) const
    {
        const Short& known = short_[bits.peek(kMaxLength) & (kShortCodes - 1)];
        if (known.length != 0) {
            bits.skip(known.length);
            return known.symbol;
        }
        return decodeLong(bits);
    }

    static constexpr unsigned kMaxLength = 16;

private:
    static constexpr unsigned kShortLength = 10, kShortCodes = 1U << kShortLength;
    struct Short {
        std::uint16_t symbol = 0;
        std::uint8_t length = 0;
    };

    std::uint32_t decodeLong(BitReader& bits) const;

    std::array<Short, kShortCodes> short_{};              // by the next bits
    std::array<std::uint32_t, kMaxLength + 1> counts_{};  // of codes, by their length
    std::vector<std::uint16_t> symbols_;                  // by length, then by number
};

HuffmanTable readHuffmanTable(BitReader& bits);

}  // namespace glim
