#include "host/image/ktx2/basis_lz.hpp"

#include "host/image/ktx2/refuse_ktx2.hpp"

#include <algorithm>

namespace glim {
namespace {

// Section "BasisLZ Global Data Structure".
struct GlobalHeader {
    std::uint16_t endpoints, selectors;
    std::uint32_t endpointBytes, selectorBytes, tableBytes, extendedBytes;
};
struct ImageDescription {
    std::uint32_t flags;
    BasisLz::Slice color, alpha;
};
static_assert(sizeof(GlobalHeader) == 20 && sizeof(ImageDescription) == 20);
constexpr std::uint32_t kIsPFrame = 2;

// Khronos Data Format Specification 1.3, chapter "ETC1 Compressed Texture Image Formats", table "Intensity modifier sets".
constexpr int kModifiers[8][2] = {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}};

BasisLz::Palette makePalette(const std::array<std::uint32_t, 3>& color, std::uint32_t intensity)
{
    const int small = kModifiers[intensity][0], large = kModifiers[intensity][1];
    const int modifiers[] = {-large, -small, small, large};
    BasisLz::Palette palette;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const int base = static_cast<int>(color[c] << 3U | color[c] >> 2U);
            palette[i][c] = static_cast<std::uint8_t>(std::clamp(base + modifiers[i], 0, 255));
        }
        palette[i][3] = 255;
    }
    return palette;
}

// Section "ETC1S VLC Decoding Procedure": groups of `bits`, each after the next, and above each a bit that says whether another follows.
std::uint32_t readVariable(BitReader& bits, unsigned groupBits)
{
    std::uint32_t value = 0;
    for (unsigned at = 0; at < 32; at += groupBits) {
        const std::uint32_t group = bits.read(groupBits + 1);
        value |= (group & ((1U << groupBits) - 1)) << at;
        if (group >> groupBits == 0) {
            return value;
        }
    }
    refuseKtx2(bits.section() + " has", "a run length of more than 32 bits", "fewer");
}

// Section "ETC1S Approximate Move to Front Routines".
class SelectorHistory {
public:
    explicit SelectorHistory(std::size_t size)
        : values_(size),
          next_(size / 2)
    {}

    void add(std::uint32_t selector)
    {
        if (values_.empty()) {
            return;
        }
        values_[next_] = selector;
        next_ = next_ + 1 == values_.size() ? values_.size() / 2 : next_ + 1;
    }
    std::size_t size() const { return values_.size(); }
    std::uint32_t use(std::size_t place)
    {
        const std::uint32_t selector = values_[place];
        std::swap(values_[place], values_[place / 2]);
        return selector;
    }

private:
    std::vector<std::uint32_t> values_;
    std::size_t next_;
};

// Section "ETC1S Slice Block Decoding": how the endpoints of each block follow from its neighbours', two bits per block. A symbol holds
// those of two by two blocks.
class Predictions {
public:
    Predictions(const HuffmanTable& symbols, std::uint32_t width)
        : symbols_(symbols),
          below_((width + 1) / 2)
    {}

    std::uint32_t next(BitReader& bits, std::uint32_t x, std::uint32_t y)
    {
        if (x % 2 == 0 && y % 2 == 0) {
            row_ = readSymbol(bits);
            below_[x / 2] = static_cast<std::uint8_t>(row_ >> 4U);
        } else if (x % 2 == 0) {
            row_ = below_[x / 2];
        }
        const std::uint32_t prediction = row_ & 3U;
        row_ >>= 2U;
        return prediction;
    }

private:
    std::uint32_t readSymbol(BitReader& bits)
    {
        constexpr std::uint32_t kRepeat = 256, kShortestRun = 3;
        if (repeats_ > 0) {
            --repeats_;
            return last_;
        }
        const std::uint32_t symbol = symbols_.decode(bits);
        if (symbol > kRepeat) {
            refuseKtx2(bits.section() + " has", "the prediction " + std::to_string(symbol), "0 to 256");
        }
        if (symbol == kRepeat) {
            repeats_ = std::uint64_t{readVariable(bits, 4)} + kShortestRun - 1;
        } else {
            last_ = symbol;
        }
        return last_;
    }

    const HuffmanTable& symbols_;
    std::vector<std::uint8_t> below_;  // of the odd row
    std::uint32_t row_ = 0, last_ = 0;
    std::uint64_t repeats_ = 0;
};

// The same section: a selector's number, a place in the history of selectors, or a run of the history's first.
class Selectors {
public:
    Selectors(const HuffmanTable& symbols, const HuffmanTable& runLengths, std::uint32_t count, std::uint32_t historySize)
        : symbols_(symbols),
          runLengths_(runLengths),
          count_(count),
          history_(historySize)
    {}

    std::uint32_t next(BitReader& bits)
    {
        std::uint32_t symbol = count_;
        if (run_ > 0) {
            --run_;
        } else if ((symbol = symbols_.decode(bits)) == count_ + history_.size()) {
            run_ = readRun(bits) - 1;
            symbol = count_;
        }
        if (symbol < count_) {
            history_.add(symbol);
            return symbol;
        }
        if (symbol - count_ >= history_.size()) {
            refuseKtx2(bits.section() + " has", "the selector " + std::to_string(symbol),
                       "less than " + std::to_string(count_ + history_.size()));
        }
        return history_.use(symbol - count_);
    }

private:
    std::uint64_t readRun(BitReader& bits) const
    {
        constexpr std::uint32_t kLong = 63, kShortest = 3;
        const std::uint32_t symbol = runLengths_.decode(bits);
        return std::uint64_t{symbol == kLong ? readVariable(bits, 7) : symbol} + kShortest;
    }

    const HuffmanTable &symbols_, &runLengths_;
    std::uint32_t count_;
    SelectorHistory history_;
    std::uint64_t run_ = 0;
};

}  // namespace

BasisLz::BasisLz(std::span<const unsigned char> globalData, std::uint32_t images)
{
    const std::size_t start = sizeof(GlobalHeader) + images * sizeof(ImageDescription);
    if (globalData.size() < start) {
        refuseKtx2("its global data has", std::to_string(globalData.size()) + " bytes", std::to_string(start) + " or more");
    }
    GlobalHeader header;
    ImageDescription first;
    std::memcpy(&header, globalData.data(), sizeof header);
    std::memcpy(&first, globalData.data() + sizeof header, sizeof first);
    const std::uint64_t size =
        start + std::uint64_t{header.endpointBytes} + header.selectorBytes + header.tableBytes + header.extendedBytes;
    if (globalData.size() != size) {
        refuseKtx2("its global data has", std::to_string(globalData.size()) + " bytes", std::to_string(size));
    }
    if (header.endpoints == 0 || header.selectors == 0) {
        refuseKtx2("it has", std::to_string(header.endpoints) + " endpoints and " + std::to_string(header.selectors) + " selectors",
                   "1 or more of each");
    }
    if ((first.flags & kIsPFrame) != 0) {
        refuseKtx2Kind("that begins with a P-frame of a video", "a still picture");
    }
    color_ = first.color;
    alpha_ = first.alpha;
    palettes_.resize(header.endpoints);
    selectors_.resize(header.selectors);
    readEndpoints(globalData.subspan(start, header.endpointBytes));
    readSelectors(globalData.subspan(start + header.endpointBytes, header.selectorBytes));
    readTables(globalData.subspan(start + header.endpointBytes + header.selectorBytes, header.tableBytes));
}

// Section "ETC1S Endpoint Codebooks".
void BasisLz::readEndpoints(std::span<const unsigned char> bytes)
{
    BitReader bits(bytes, "its endpoint codebook");
    const HuffmanTable steps[] = {readHuffmanTable(bits), readHuffmanTable(bits), readHuffmanTable(bits)};
    const HuffmanTable intensitySteps = readHuffmanTable(bits);
    const bool grey = bits.read(1) != 0;
    std::uint32_t intensity = 0;
    std::array<std::uint32_t, 3> color{16, 16, 16};
    for (Palette& palette : palettes_) {
        intensity = (intensity + intensitySteps.decode(bits)) & 7U;
        for (std::size_t c = 0; c < (grey ? 1 : 3); ++c) {
            const HuffmanTable& table = steps[color[c] < 10 ? 0 : color[c] < 22 ? 1 : 2];
            color[c] = (color[c] + table.decode(bits)) & 31U;
        }
        if (grey) {
            color[1] = color[2] = color[0];
        }
        palette = makePalette(color, intensity);
    }
}

// Section "ETC1S Selector Codebooks".
void BasisLz::readSelectors(std::span<const unsigned char> bytes)
{
    BitReader bits(bytes, "its selector codebook");
    if (const std::uint32_t reserved = bits.read(2); reserved != 0) {
        refuseKtx2(bits.section() + " begins with", "the bits " + std::to_string(reserved), "0");
    }
    const bool raw = bits.read(1) != 0;
    const HuffmanTable changes = raw ? HuffmanTable() : readHuffmanTable(bits);
    const Selector* before = nullptr;
    for (Selector& selector : selectors_) {
        for (std::size_t row = 0; row < 4; ++row) {
            const std::uint32_t value = raw || before == nullptr ? bits.read(8) : changes.decode(bits) ^ (*before)[row];
            selector[row] = static_cast<std::uint8_t>(value);
        }
        before = &selector;
    }
}

// Section "ETC1S Slice Huffman Tables".
void BasisLz::readTables(std::span<const unsigned char> bytes)
{
    BitReader bits(bytes, "its part of Huffman tables");
    predictions_ = readHuffmanTable(bits);
    endpointSteps_ = readHuffmanTable(bits);
    selectorSymbols_ = readHuffmanTable(bits);
    runLengths_ = readHuffmanTable(bits);
    historySize_ = bits.read(13);
}

std::vector<EtcBlock> BasisLz::decodeSlice(std::span<const unsigned char> slice, std::uint32_t width, std::uint32_t height,
                                           const std::string& name) const
{
    BitReader bits(slice, name);
    Predictions predictions(predictions_, width);
    Selectors selectors(selectorSymbols_, runLengths_, static_cast<std::uint32_t>(selectors_.size()), historySize_);
    std::vector<EtcBlock> blocks(std::size_t{width} * height);
    const auto count = static_cast<std::uint32_t>(palettes_.size());
    std::uint32_t endpoint = 0;
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            EtcBlock* const block = &blocks[std::size_t{y} * width + x];
            const std::uint32_t prediction = predictions.next(bits, x, y);
            constexpr std::uint32_t kLeft = 0, kAbove = 1, kAboveLeft = 2;
            if (((prediction == kLeft || prediction == kAboveLeft) && x == 0) ||
                ((prediction == kAbove || prediction == kAboveLeft) && y == 0)) {
                refuseKtx2(name + " repeats", "a block beyond the edge at block " + std::to_string(x) + ", " + std::to_string(y),
                           "one within");
            }
            if (prediction == kAbove) {
                endpoint = (block - width)->endpoint;
            } else if (prediction == kAboveLeft) {
                endpoint = (block - width - 1)->endpoint;
            } else if (prediction != kLeft) {
                endpoint += endpointSteps_.decode(bits);
                endpoint -= endpoint >= count ? count : 0;
                if (endpoint >= count) {
                    refuseKtx2(name + " has", "the endpoint " + std::to_string(endpoint), "less than " + std::to_string(count));
                }
            }
            *block = {static_cast<std::uint16_t>(endpoint), static_cast<std::uint16_t>(selectors.next(bits))};
        }
    }
    return blocks;
}

}  // namespace glim
