#include "host/scene/gltf/decode_attributes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace glim {
namespace {

constexpr std::size_t kGroupSize = 16, kMaxBlockElements = 256, kMaxBlockBytes = 8192, kChannelBytes = 4;
constexpr std::size_t kMinTail0 = 32, kMinTail1 = 24;
constexpr unsigned char kHeader0 = 0xa0, kHeader1 = 0xa1;

// How many bits a delta has in a group, by the group's two header bits: in version 0, and in version 1 by the control mode.
using BitLengths = std::array<unsigned, 4>;
constexpr BitLengths kBitLengths0 = {0, 2, 4, 8};
constexpr BitLengths kBitLengths1[] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
constexpr unsigned kAllZero = 2, kLiteral = 3;  // control modes without groups

// Of one byte of each element of a block.
using Deltas = std::array<unsigned char, kMaxBlockElements>;

// What stands between a stream's header and its tail.
class DeltaReader {
public:
    explicit DeltaReader(std::span<const unsigned char> bytes)
        : rest_(bytes)
    {}

    bool isAtEnd() const { return rest_.empty(); }

    // Null if so many are not left.
    const unsigned char* take(std::size_t count)
    {
        if (count > rest_.size()) {
            return nullptr;
        }
        const unsigned char* bytes = rest_.data();
        rest_ = rest_.subspan(count);
        return bytes;
    }

    bool readDeltas(unsigned control, std::size_t count, Deltas& deltas)
    {
        switch (control) {
        case kAllZero: deltas.fill(0); return true;
        case kLiteral: return copy(count, deltas.data());
        default: return readGroups(kBitLengths1[control], count, deltas);
        }
    }

    bool readGroups(const BitLengths& lengths, std::size_t count, Deltas& deltas)
    {
        const std::size_t groups = (count + kGroupSize - 1) / kGroupSize;
        const unsigned char* header = take((groups + 3) / 4);
        bool isRight = header != nullptr;
        for (std::size_t group = 0; isRight && group < groups; ++group) {
            isRight = readGroup(lengths[header[group / 4] >> 2U * (group % 4) & 3U], &deltas[kGroupSize * group]);
        }
        return isRight;
    }

private:
    bool copy(std::size_t count, unsigned char* deltas)
    {
        const unsigned char* bytes = take(count);
        if (bytes != nullptr) {
            std::copy_n(bytes, count, deltas);
        }
        return bytes != nullptr;
    }

    bool readGroup(unsigned bits, unsigned char* deltas)
    {
        switch (bits) {
        case 0: std::fill_n(deltas, kGroupSize, static_cast<unsigned char>(0)); return true;
        case 1: return readPacked<1>(deltas);
        case 2: return readPacked<2>(deltas);
        case 4: return readPacked<4>(deltas);
        default: return copy(kGroupSize, deltas);
        }
    }

    // A delta whose bits are all 1 follows whole, after those of the group. Bits begin with the least significant one of a byte; longer
    // deltas with the most significant ones.
    template <unsigned kBits>
    bool readPacked(unsigned char* deltas)
    {
        constexpr unsigned kPerByte = 8 / kBits, kSentinel = (1U << kBits) - 1U;
        const unsigned char* packed = take(kGroupSize / kPerByte);
        for (unsigned i = 0; packed != nullptr && i < kGroupSize; ++i) {
            const unsigned place = kBits == 1 ? i % kPerByte : kPerByte - 1 - i % kPerByte;
            const unsigned delta = packed[i / kPerByte] >> kBits * place & kSentinel;
            if (delta != kSentinel) {
                deltas[i] = static_cast<unsigned char>(delta);
            } else if (!copy(1, &deltas[i])) {
                return false;
            }
        }
        return packed != nullptr;
    }

    std::span<const unsigned char> rest_;
};

template <class Unsigned>
Unsigned unzigzag(Unsigned value)
{
    return static_cast<Unsigned>((value & 1U) != 0 ? ~(value >> 1U) : value >> 1U);
}

// Four bytes of an element, as deltas and as values.
using Word = std::uint32_t;

// What a channel's mode makes of a delta and the value before it.
struct ChannelMode {
    unsigned kind, rotation;

    explicit ChannelMode(unsigned char byte)
        : kind(byte & 15U),
          rotation(byte >> 4U)
    {}

    bool isKnown() const { return kind == 2 || (kind < 2 && rotation == 0); }

    Word add(Word delta, Word last) const
    {
        if (kind == 2) {
            return last ^ std::rotr(delta, static_cast<int>(rotation));
        }
        return kind == 1 ? addParts<std::uint16_t>(delta, last) : addParts<std::uint8_t>(delta, last);
    }

private:
    template <class Part>
    static Word addParts(Word delta, Word last)
    {
        Word sum = 0;
        for (unsigned shift = 0; shift < 32; shift += 8 * sizeof(Part)) {
            const auto part = static_cast<Part>(static_cast<Part>(last >> shift) + unzigzag(static_cast<Part>(delta >> shift)));
            sum |= Word{part} << shift;
        }
        return sum;
    }
};

Word wordAt(const unsigned char* bytes) { return bytes[0] | Word{bytes[1]} << 8U | Word{bytes[2]} << 16U | Word{bytes[3]} << 24U; }

void storeWord(Word word, unsigned char* bytes)
{
    for (unsigned i = 0; i < kChannelBytes; ++i) {
        bytes[i] = static_cast<unsigned char>(word >> 8U * i);
    }
}

class AttributeDecoder {
public:
    // `modes`: of the channels; none in version 0.
    AttributeDecoder(std::span<const unsigned char> body, std::span<const unsigned char> baseline, std::span<const unsigned char> modes)
        : reader_(body),
          last_(baseline),
          modes_(modes)
    {}

    bool decode(std::span<unsigned char> elements)
    {
        const std::size_t stride = last_.size();
        const std::size_t most = std::min(kMaxBlockBytes / stride / kGroupSize * kGroupSize, kMaxBlockElements);
        bool isRight = std::ranges::all_of(modes_, [](unsigned char mode) { return ChannelMode(mode).isKnown(); });
        while (isRight && !elements.empty()) {
            const std::size_t count = std::min(most, elements.size() / stride);
            isRight = decodeBlock(count, elements.data());
            last_ = elements.subspan((count - 1) * stride, stride);
            elements = elements.subspan(count * stride);
        }
        return isRight && reader_.isAtEnd();
    }

private:
    bool decodeBlock(std::size_t count, unsigned char* elements)
    {
        const std::size_t channels = last_.size() / kChannelBytes;
        const unsigned char* controls = modes_.empty() ? nullptr : reader_.take(channels);
        bool isRight = modes_.empty() || controls != nullptr;
        for (std::size_t channel = 0; isRight && channel < channels; ++channel) {
            std::array<Deltas, kChannelBytes> deltas;
            for (unsigned i = 0; isRight && i < kChannelBytes; ++i) {
                isRight = controls == nullptr ? reader_.readGroups(kBitLengths0, count, deltas[i])
                                              : reader_.readDeltas(controls[channel] >> 2U * i & 3U, count, deltas[i]);
            }
            if (isRight) {
                addDeltas(deltas, channel, count, elements);
            }
        }
        return isRight;
    }

    void addDeltas(const std::array<Deltas, kChannelBytes>& deltas, std::size_t channel, std::size_t count, unsigned char* elements) const
    {
        const ChannelMode mode(modes_.empty() ? 0 : modes_[channel]);
        Word last = wordAt(&last_[kChannelBytes * channel]);
        for (std::size_t i = 0; i < count; ++i) {
            const unsigned char delta[] = {deltas[0][i], deltas[1][i], deltas[2][i], deltas[3][i]};
            last = mode.add(wordAt(delta), last);
            storeWord(last, &elements[last_.size() * i + kChannelBytes * channel]);
        }
    }

    DeltaReader reader_;
    std::span<const unsigned char> last_;  // the element before the block
    std::span<const unsigned char> modes_;
};

// A component of the result is at most one step off, as the extension allows.
template <class Component>
void decodeColor(unsigned char* element)
{
    constexpr int kMax = std::numeric_limits<Component>::max();
    Component in[4];
    std::memcpy(in, element, sizeof in);
    const int y = in[0], co = static_cast<std::make_signed_t<Component>>(in[1]), cg = static_cast<std::make_signed_t<Component>>(in[2]);
    // The highest bit of alpha says how many bits all have; without any the element is none that an encoder may write.
    const unsigned one = std::max(std::bit_ceil(in[3] + 1U), 2U) - 1U, alpha = in[3] & one >> 1U;
    const float scale = static_cast<float>(kMax) / static_cast<float>(one);
    const int rgba[] = {y + co - cg, y + cg, y - co - cg, static_cast<int>(alpha << 1U | (alpha & 1U))};
    Component out[4];
    for (int i = 0; i < 4; ++i) {
        out[i] = static_cast<Component>(std::clamp(std::lround(static_cast<float>(rgba[i]) * scale), 0L, long{kMax}));
    }
    std::memcpy(element, out, sizeof out);
}

}  // namespace

bool decodeAttributes(std::span<const unsigned char> stream, std::size_t stride, std::span<unsigned char> elements)
{
    const bool isFirst = !stream.empty() && stream[0] == kHeader0;
    if (!isFirst && (stream.empty() || stream[0] != kHeader1)) {
        return false;
    }
    const std::size_t modes = isFirst ? 0 : stride / kChannelBytes, tail = std::max(stride + modes, isFirst ? kMinTail0 : kMinTail1);
    if (stream.size() < 1 + tail) {
        return false;
    }
    const std::size_t baseline = stream.size() - modes - stride;
    return AttributeDecoder(stream.subspan(1, stream.size() - 1 - tail), stream.subspan(baseline, stride), stream.last(modes))
        .decode(elements);
}

void decodeColors(std::size_t stride, std::span<unsigned char> elements)
{
    for (std::size_t at = 0; at < elements.size(); at += stride) {
        stride == 4 ? decodeColor<std::uint8_t>(&elements[at]) : decodeColor<std::uint16_t>(&elements[at]);
    }
}

}  // namespace glim
