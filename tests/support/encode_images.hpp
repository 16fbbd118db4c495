// Image files of every kind that glim reads, as bytes, by the libraries that also decode them.
#pragma once

#include <png.h>

#include <cstdint>
#include <string>
#include <vector>

namespace glim::test {

using Bytes = std::vector<unsigned char>;

struct PngFormat {
    int colorType = PNG_COLOR_TYPE_RGB, bitDepth = 8;
    bool interlaced = false;
    std::vector<png_color> palette;
    Bytes transparentEntries;                           // alpha of the palette's first entries
    std::vector<std::uint16_t> transparentColor;        // of grey (one) or RGB (three), at the file's depth
    std::vector<std::pair<std::string, Bytes>> chunks;  // further ones, before the image's data
};

// `rows`: packed as the file has them, one after another.
Bytes encodePng(std::uint32_t width, std::uint32_t height, const Bytes& rows, const PngFormat& format = {});

// Changes width and height in a PNG's header.
Bytes withPngSize(Bytes png, std::uint32_t width, std::uint32_t height);

enum class JpegColors { Grey, Color, Cmyk };  // Cmyk: as Adobe writes it, the inks inverted

// Of the best quality. `values`: a byte per channel.
Bytes encodeJpeg(std::uint32_t width, std::uint32_t height, const Bytes& values, JpegColors colors, bool progressive = false);

// Lossless.
Bytes encodeWebp(int width, int height, const Bytes& rgba);

}  // namespace glim::test
