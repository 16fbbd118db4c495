// ETC1S under BasisLZ: KTX 2.0 specification, appendices "BasisLZ Global Data" and "BasisLZ/ETC1S Bitstream Specification".
#pragma once

#include "host/image/ktx2/huffman.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace glim {

// Of each block of 4x4 texels: its entries in the two codebooks.
struct EtcBlock {
    std::uint16_t endpoint = 0, selector = 0;
};

class BasisLz {
public:
    using Palette = std::array<std::array<std::uint8_t, 4>, 4>;  // RGBA, the darkest first; alpha is 255
    using Selector = std::array<std::uint8_t, 4>;                // a byte per row, two bits per texel, the left one lowest

    // Where an image's parts lie in the bytes of its level.
    struct Slice {
        std::uint32_t offset = 0, length = 0;
    };

    // `images`: how many the file has, of all levels.
    BasisLz(std::span<const unsigned char> globalData, std::uint32_t images);

    Slice color() const { return color_; }  // of the first image
    Slice alpha() const { return alpha_; }

    // In rows from the top. `name`: for sentences, as "its first slice".
    std::vector<EtcBlock> decodeSlice(std::span<const unsigned char> slice, std::uint32_t width, std::uint32_t height,
                                      const std::string& name) const;

    const std::array<std::uint8_t, 4>& texel(EtcBlock block, std::uint32_t column, std::uint32_t row) const
    {
        return palettes_[block.endpoint][selectors_[block.selector][row] >> 2 * column & 3U];
    }

private:
    void readEndpoints(std::span<const unsigned char> bytes);
    void readSelectors(std::span<const unsigned char> bytes);
    void readTables(std::span<const unsigned char> bytes);

    Slice color_, alpha_;
    std::vector<Palette> palettes_;
    std::vector<Selector> selectors_;
    HuffmanTable predictions_, endpointSteps_, selectorSymbols_, runLengths_;
    std::uint32_t historySize_ = 0;
};

}  // namespace glim
