#include "tests/support/encode_images.hpp"

#include <gtest/gtest.h>
#include <webp/encode.h>

#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>

namespace glim::test {
namespace {

void put32(Bytes& bytes, std::size_t at, std::uint32_t value)
{
    for (std::size_t i = 0; i < 4; ++i) {
        bytes[at + i] = static_cast<unsigned char>(value >> (24U - 8U * i) & 255U);
    }
}

std::uint32_t crcOf(const unsigned char* bytes, std::size_t count)
{
    std::uint32_t crc = 0xffffffffU;
    for (std::size_t i = 0; i < count; ++i) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) {
            crc = crc >> 1U ^ ((crc & 1U) != 0 ? 0xedb88320U : 0U);
        }
    }
    return ~crc;
}

}  // namespace

Bytes encodePng(std::uint32_t width, std::uint32_t height, const Bytes& rows, const PngFormat& format)
{
    Bytes bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &bytes,
        [](png_structp to, png_bytep data, png_size_t count) {
            auto& all = *static_cast<Bytes*>(png_get_io_ptr(to));
            all.insert(all.end(), data, data + count);
        },
        nullptr);
    png_set_IHDR(png, info, width, height, format.bitDepth, format.colorType, format.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!format.palette.empty()) {
        png_set_PLTE(png, info, format.palette.data(), static_cast<int>(format.palette.size()));
        png_set_tRNS(png, info, format.transparentEntries.data(), static_cast<int>(format.transparentEntries.size()), nullptr);
    }
    if (!format.transparentColor.empty()) {
        png_color_16 color{};
        color.gray = color.red = format.transparentColor[0];
        color.green = format.transparentColor.size() > 1 ? format.transparentColor[1] : std::uint16_t{0};
        color.blue = format.transparentColor.size() > 2 ? format.transparentColor[2] : std::uint16_t{0};
        png_set_tRNS(png, info, nullptr, 0, &color);
    }
    png_write_info(png, info);
    for (const auto& [name, data] : format.chunks) {
        png_write_chunk(png, reinterpret_cast<png_const_bytep>(name.data()), data.data(), data.size());
    }
    const std::size_t rowBytes = png_get_rowbytes(png, info);
    EXPECT_EQ(rows.size(), rowBytes * height);
    std::vector<png_bytep> pointers;
    for (std::uint32_t y = 0; y < height; ++y) {
        pointers.push_back(const_cast<png_bytep>(rows.data() + y * rowBytes));
    }
    png_write_image(png, pointers.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

Bytes withPngSize(Bytes png, std::uint32_t width, std::uint32_t height)
{
    put32(png, 16, width);
    put32(png, 20, height);
    put32(png, 29, crcOf(&png[12], 17));
    return png;
}

Bytes encodeJpeg(std::uint32_t width, std::uint32_t height, const Bytes& values, JpegColors colors, bool progressive)
{
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &memory, &size);
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = colors == JpegColors::Grey ? 1 : colors == JpegColors::Color ? 3 : 4;
    jpeg.in_color_space = colors == JpegColors::Grey ? JCS_GRAYSCALE : colors == JpegColors::Color ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (progressive) {
        jpeg_simple_progression(&jpeg);
    }
    jpeg_start_compress(&jpeg, TRUE);
    const std::size_t rowBytes = std::size_t{width} * static_cast<std::size_t>(jpeg.input_components);
    while (jpeg.next_scanline < height) {
        JSAMPROW row = const_cast<JSAMPROW>(values.data() + jpeg.next_scanline * rowBytes);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    const Bytes bytes(memory, memory + size);
    std::free(memory);
    return bytes;
}

Bytes encodeWebp(int width, int height, const Bytes& rgba)
{
    std::uint8_t* memory = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(rgba.data(), width, height, width * 4, &memory);
    const Bytes bytes(memory, memory + size);
    WebPFree(memory);
    return bytes;
}

}  // namespace glim::test
