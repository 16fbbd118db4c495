// Pictures in each kind of file, by the ending of the name.
#include "host/image/picture_file.hpp"
#include "host/error.hpp"
#include "host/image/decode_image.hpp"
#include "tests/support/decode_png.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace glim {
namespace {

using test::readFileBytes;
using test::ScratchFolder;

constexpr std::uint32_t kWidth = 40, kHeight = 24;

// Smooth but for columns of saturated red and blue, which differ in nothing but colour.
std::vector<Rgb8> picture()
{
    std::vector<Rgb8> pixels;
    for (std::uint32_t y = 0; y < kHeight; ++y) {
        for (std::uint32_t x = 0; x < kWidth; ++x) {
            const bool isStripes = y >= kHeight / 2;
            pixels.push_back(
                isStripes ? Rgb8{static_cast<std::uint8_t>(x % 2 == 0 ? 200 : 20), 60, static_cast<std::uint8_t>(x % 2 == 0 ? 20 : 200)}
                          : Rgb8{static_cast<std::uint8_t>(6 * x), static_cast<std::uint8_t>(9 * y), 128});
        }
    }
    return pixels;
}

DecodedImage decoded(const std::filesystem::path& path)
{
    const std::string bytes = readFileBytes(path);
    return decodeImage({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
}

// The largest difference of a byte.
int errorOf(const DecodedImage& image, const std::vector<Rgb8>& pixels)
{
    EXPECT_EQ(image.width, kWidth);
    EXPECT_EQ(image.height, kHeight);
    int largest = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            largest = std::max(largest, std::abs(image.rgba8.at(4 * i + k) - pixels[i][k]));
        }
    }
    return largest;
}

TEST(PictureFile, TheEndingChoosesTheKind)
{
    EXPECT_EQ(getPictureKind("a.png"), PictureKind::Png);
    EXPECT_EQ(getPictureKind("a.jpg"), PictureKind::Jpeg);
    EXPECT_EQ(getPictureKind("b/a.JPEG"), PictureKind::Jpeg);
    EXPECT_EQ(getPictureKind("a.png.WebP"), PictureKind::Webp);
    for (const char* other : {"a.gif", "png", "a.jpg.exr", "a", "", "a.jp", "jpg/a"}) {
        EXPECT_EQ(getPictureKind(other), std::nullopt) << other;
    }
}

TEST(PictureFile, HoldsThePicture)
{
    const ScratchFolder folder;
    const std::vector<Rgb8> pixels = picture();
    for (const char* name : {"a.png", "a.webp", "a.jpg", "b.jpeg"}) {
        writePicture(folder / name, kWidth, kHeight, pixels);
        const bool lossy = getPictureKind(name) == PictureKind::Jpeg;
        const int error = errorOf(decoded(folder / name), pixels);
        EXPECT_LE(error, lossy ? 12 : 0);  // with colours in half the resolution the stripes would be off by 90
        EXPECT_EQ(readFileBytes(folder / name).substr(0, 4), lossy ? "\xff\xd8\xff\xe0" : name[2] == 'p' ? "\x89PNG" : "RIFF");
    }
    EXPECT_EQ(folder.entries(), 4);
}

// Also the colours of transparent pixels.
TEST(PictureFile, HoldsAlphaWithoutLoss)
{
    const ScratchFolder folder;
    std::vector<Rgba8> pixels;
    std::vector<std::uint8_t> bytes;
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
        const auto part = [i](std::uint32_t factor) { return static_cast<std::uint8_t>(i * factor); };
        pixels.push_back({part(1), part(7), part(31), i % 3 == 0 ? std::uint8_t{0} : part(5)});
        bytes.insert(bytes.end(), pixels.back().begin(), pixels.back().end());
    }
    for (const char* name : {"a.png", "a.webp"}) {
        writePicture(folder / name, kWidth, kHeight, pixels);
        const DecodedImage image = decoded(folder / name);
        EXPECT_TRUE(image.hasAlpha);
        EXPECT_EQ(image.rgba8, bytes) << name;
    }
}

TEST(PictureFile, JpegIsOfTheStatedQuality)
{
    const ScratchFolder folder;
    writePicture(folder / "a.jpg", kWidth, kHeight, picture());
    const std::string bytes = readFileBytes(folder / "a.jpg");
    // The standard's first quantizer is 16 (ITU-T T.81, table K.1), and libjpeg's quality 95 scales it by .1.
    const std::size_t table = bytes.find("\xff\xdb"), frame = bytes.find("\xff\xc0");
    ASSERT_NE(table, std::string::npos);
    ASSERT_NE(frame, std::string::npos);
    EXPECT_EQ(bytes.at(table + 5), 2);
    for (std::size_t component = 0; component < 3; ++component) {
        EXPECT_EQ(bytes.at(frame + 11 + 3 * component), 0x11) << "one sample a pixel";
    }
}

TEST(PictureFile, IsRefusedWhereItCannotBe)
{
    const ScratchFolder folder;
    const std::vector<Rgb8> tooLong(70000);
    const auto expectRefused = [&](const char* name, std::uint32_t width, std::uint32_t height, MessageId id, test::Parts parts) {
        parts.file = folder / name;
        test::expectRefusal<InputError>([&] { writePicture(folder / name, width, height, tooLong); }, id, parts);
    };
    expectRefused("a.gif", 1, 1, MessageId::UnknownFormat, {.expected = ".png, .jpg, .jpeg or .webp"});
    for (const char* name : {"none/a.png", "none/a.jpg", "none/a.webp"}) {
        expectRefused(name, 1, 1, MessageId::FileMissing, {.value = folder / "none"});
    }
    expectRefused("a.webp", 16384, 1, MessageId::TooLarge, {.value = "16384x1", .expected = "16383"});
    expectRefused("a.jpg", 1, 65501, MessageId::TooLarge, {.value = "1x65501", .expected = "65500"});
    EXPECT_EQ(folder.entries(), 0);
    writePicture(folder / "a.webp", 16383, 1, tooLong);
    writePicture(folder / "a.jpg", 1, 65500, tooLong);
    EXPECT_EQ(folder.entries(), 2);
}

}  // namespace
}  // namespace glim
