#include "host/error.hpp"
#include "host/image/png.hpp"
#include "tests/support/decode_png.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace glim {
namespace {

using test::ScratchFolder;
using test::bytesOfFile;
using test::Rgb;
using test::decodePng;

Image makeImage(const std::vector<std::array<float, 3>>& pixels, std::uint32_t width)
{
    Image image;
    image.width = width;
    image.height = static_cast<std::uint32_t>(pixels.size()) / width;
    for (const auto& pixel : pixels) {
        image.channels["R"].push_back(pixel[0]);
        image.channels["G"].push_back(pixel[1]);
        image.channels["B"].push_back(pixel[2]);
    }
    return image;
}

// Published pairs of the sRGB curve, and its inverse: each byte is nearest to the light it stands for.
TEST(Png, TransferFunctionIsSrgb)
{
    EXPECT_EQ(srgbByte(-1.0), 0);
    EXPECT_EQ(srgbByte(0.0), 0);
    EXPECT_EQ(srgbByte(0.18), 118);
    EXPECT_EQ(srgbByte(0.5), 188);
    EXPECT_EQ(srgbByte(1.0), 255);
    EXPECT_EQ(srgbByte(1e30), 255);
    for (int byte = 0; byte < 256; ++byte) {
        const double encoded = byte / 255.0;
        const double linear = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
        EXPECT_EQ(srgbByte(linear), byte);
    }
}

TEST(Png, HoldsTheExposedPixelsFromTheTopLeft)
{
    const ScratchFolder folder;
    const Image image = makeImage(
        {{0, 0, 0}, {0.25F, 0, 0}, {0, 0.25F, 0}, {0, 0, 0.25F}, {0.09F, 0.09F, 0.09F}, {9, 1, -1}}, 3);
    writePng(folder / "a.png", image, 1.0);
    EXPECT_EQ(decodePng(folder / "a.png"),
              (std::vector<Rgb>{{0, 0, 0}, {188, 0, 0}, {0, 188, 0}, {0, 0, 188}, {118, 118, 118}, {255, 255, 0}}));
    writePng(folder / "b.png", image, -1.0);
    EXPECT_EQ(decodePng(folder / "b.png")[1], (Rgb{srgbByte(0.125), 0, 0}));
    EXPECT_EQ(folder.entries(), 2);
}

TEST(Png, ShowsNonFinitePixelsInMagenta)
{
    const ScratchFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    writePng(folder / "a.png", makeImage({{nan, 0, 0}, {0, infinity, 0}, {0, 0, -infinity}, {1, 1, 1}}, 2), 0.0);
    const Rgb magenta{255, 0, 255};
    EXPECT_EQ(decodePng(folder / "a.png"), (std::vector<Rgb>{magenta, magenta, magenta, {255, 255, 255}}));
}

TEST(Png, TheSameImageGivesTheSameBytes)
{
    const ScratchFolder folder;
    const Image image = makeImage({{0.1F, 0.2F, 0.3F}, {0.4F, 0.5F, 0.6F}}, 2);
    writePng(folder / "a.png", image, 0.0);
    writePng(folder / "b.png", image, 0.0);
    EXPECT_EQ(bytesOfFile(folder / "a.png"), bytesOfFile(folder / "b.png"));
}

TEST(Png, IsRefusedWhereItCannotBe)
{
    const ScratchFolder folder;
    const Image image = makeImage({{0, 0, 0}}, 1);
    test::expectRefusal<InputError>([&] { writePng(folder / "missing/a.png", image, 0.0); }, "does not exist");
    Image tooWide = image;  // for libpng, which then leaves by longjmp
    tooWide.width = 0x80000000U;
    test::expectRefusal<InputError>([&] { writePng(folder / "a.png", tooWide, 0.0); }, "a.png: cannot be written as PNG (Invalid IHDR data).");
    EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace glim
