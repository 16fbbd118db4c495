// A PNG as bytes, through libpng's own reader.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <filesystem>
#include <vector>

namespace glim::test {

using Rgb = std::array<int, 3>;

// Row 0 at the top. Fails the test unless the file is 8 bits a channel, sRGB, without alpha.
inline std::vector<Rgb> decodePng(const std::filesystem::path& path)
{
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_file(&png, path.c_str()), 0) << png.message;
    EXPECT_EQ(png.format, PNG_FORMAT_RGB + 0U);
    std::vector<png_byte> bytes(PNG_IMAGE_SIZE(png));
    EXPECT_NE(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr), 0) << png.message;
    std::vector<Rgb> pixels;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        pixels.push_back({bytes[i], bytes[i + 1], bytes[i + 2]});
    }
    return pixels;
}

}  // namespace glim::test
