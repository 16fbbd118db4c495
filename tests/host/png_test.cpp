#include "host/image/png.hpp"
#include "host/error.hpp"
#include "tests/support/decode_png.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim {
namespace {

using test::decodePng;
using test::readFileBytes;
using test::ScratchFolder;

// Published pairs of the sRGB curve; and its inverse: each byte is the one nearest to the light that it stands for.
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

TEST(Png, HoldsThePixelsFromTheTopLeft)
{
    const ScratchFolder folder;
    const std::vector<Rgb8> pixels{{0, 0, 0}, {188, 0, 0}, {0, 187, 0}, {0, 0, 186}, {118, 119, 120}, {255, 255, 0}};
    const std::vector<test::Rgb> read{{0, 0, 0}, {188, 0, 0}, {0, 187, 0}, {0, 0, 186}, {118, 119, 120}, {255, 255, 0}};
    writePng(folder / "a.png", 3, 2, pixels);
    EXPECT_EQ(decodePng(folder / "a.png"), read);
    writePng(folder / "b.png", 3, 2, pixels);
    EXPECT_EQ(readFileBytes(folder / "a.png"), readFileBytes(folder / "b.png"));
    EXPECT_EQ(folder.entries(), 2);
}

TEST(Png, IsRefusedWhereItCannotBe)
{
    const ScratchFolder folder;
    const std::vector<Rgb8> one(1);
    test::expectRefusal<InputError>([&] { writePng(folder / "missing/a.png", 1, 1, one); }, MessageId::FileMissing,
                                    {.file = "a.png", .value = folder / "missing"});
    // Too wide for libpng, which then leaves by longjmp.
    test::expectRefusal<InputError>([&] { writePng(folder / "a.png", 0x80000000U, 1, one); }, MessageId::FileUnwritable, {.file = "a.png"});
    EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace glim
