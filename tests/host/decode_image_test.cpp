// Images of every kind, whole and broken: each decodes to the texels that it holds, or is refused.
#include "host/image/decode_image.hpp"

#include "host/error.hpp"
#include "host/image/shrink_image.hpp"
#include "host/image/srgb.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/encode_images.hpp"
#include "tests/support/expect_message.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glim::test {
namespace {

using Texels = std::vector<std::uint8_t>;

bool isRefused(const Bytes& bytes)
{
    try {
        decodeImage(bytes);
    } catch (const InputError&) {
        return true;
    }
    return false;
}

void expectBroken(const Bytes& bytes)
{
    expectRefusal<InputError>([&] { decodeImage(bytes); }, MessageId::FileDamaged);
}

Bytes truncated(Bytes bytes, std::size_t by)
{
    bytes.resize(bytes.size() - by);
    return bytes;
}

TEST(DecodeImageTest, GreyOfFewBitsIsScaledToEight)
{
    const auto decoded = [](int bits, unsigned char row) { return decodeImage(encodePng(2, 1, {row}, {PNG_COLOR_TYPE_GRAY, bits})).rgba8; };
    EXPECT_EQ(decoded(1, 0x40), (Texels{0, 0, 0, 255, 255, 255, 255, 255}));
    EXPECT_EQ(decoded(2, 0x60), (Texels{85, 85, 85, 255, 170, 170, 170, 255}));
    EXPECT_EQ(decoded(4, 0x3c), (Texels{51, 51, 51, 255, 204, 204, 204, 255}));
    EXPECT_EQ(decodeImage(encodePng(1, 1, {7, 9}, {PNG_COLOR_TYPE_GRAY_ALPHA})).rgba8, (Texels{7, 7, 7, 9}));
}

TEST(DecodeImageTest, TransparentColoursOfPngsAreAlpha)
{
    PngFormat palette{PNG_COLOR_TYPE_PALETTE, 2};
    palette.palette = {{10, 20, 30}, {40, 50, 60}, {70, 80, 90}};
    palette.transparentEntries = {128, 0};
    const DecodedImage image = decodeImage(encodePng(3, 1, {0x18}, palette));
    EXPECT_TRUE(image.hasAlpha);
    EXPECT_EQ(image.rgba8, (Texels{10, 20, 30, 128, 40, 50, 60, 0, 70, 80, 90, 255}));
    PngFormat rgb;
    rgb.transparentColor = {1, 2, 3};
    EXPECT_EQ(decodeImage(encodePng(2, 1, {1, 2, 3, 1, 2, 4}, rgb)).rgba8, (Texels{1, 2, 3, 0, 1, 2, 4, 255}));
    PngFormat grey{PNG_COLOR_TYPE_GRAY, 16};
    grey.transparentColor = {0x1234};
    EXPECT_EQ(decodeImage(encodePng(2, 1, {0x12, 0x34, 0x12, 0x35}, grey)).rgba16,
              (std::vector<std::uint16_t>{0x1234, 0x1234, 0x1234, 0, 0x1235, 0x1235, 0x1235, 65535}));
    EXPECT_FALSE(decodeImage(encodePng(1, 1, {1, 2, 3})).hasAlpha);
}

TEST(DecodeImageTest, InterlacedPngsAreThePlainOnes)
{
    Bytes rows;
    for (int i = 0; i < 13 * 11 * 3; ++i) {
        rows.push_back(static_cast<unsigned char>(i * 7));
    }
    PngFormat interlaced;
    interlaced.interlaced = true;
    EXPECT_EQ(decodeImage(encodePng(13, 11, rows, interlaced)).rgba8, decodeImage(encodePng(13, 11, rows)).rgba8);
}

TEST(DecodeImageTest, JpegsOfEveryColourSpace)
{
    const auto expectNear = [](const Bytes& jpeg, const std::array<int, 3>& color) {
        const DecodedImage image = decodeImage(jpeg);
        EXPECT_EQ(image.rgba8.size(), 16U * 16U * 4U);
        for (std::size_t i = 0; i < image.rgba8.size(); ++i) {
            EXPECT_NEAR(image.rgba8[i], i % 4 == 3 ? 255 : color[i % 4], 3) << i;
        }
    };
    const auto filled = [](const Bytes& pixel) {
        Bytes values;
        for (int i = 0; i < 256; ++i) {
            values.insert(values.end(), pixel.begin(), pixel.end());
        }
        return values;
    };
    expectNear(encodeJpeg(16, 16, filled({90}), JpegColors::Grey), {90, 90, 90});
    expectNear(encodeJpeg(16, 16, filled({200, 100, 50}), JpegColors::Color), {200, 100, 50});
    expectNear(encodeJpeg(16, 16, filled({200, 100, 50}), JpegColors::Color, true), {200, 100, 50});
    // Inverted inks: 255 - ink, and black multiplies.
    expectNear(encodeJpeg(16, 16, filled({255, 128, 0, 128}), JpegColors::Cmyk), {128, 64, 0});
}

// A byte between two markers is noted by the library, and shows in no pixel.
TEST(DecodeImageTest, JpegsWithHarmlessFlawsDecode)
{
    const Bytes jpeg = encodeJpeg(8, 8, Bytes(64, 90), JpegColors::Grey);
    Bytes flawed = jpeg;
    const std::ptrdiff_t secondMarker = 4 + 256 * jpeg[4] + jpeg[5];  // behind the first segment, whose length is at byte 4
    flawed.insert(flawed.begin() + secondMarker, {0x00, 0x00});
    EXPECT_EQ(decodeImage(flawed).rgba8, decodeImage(jpeg).rgba8);
}

// What is missing besides the marker is made up, and refused: the last bits of a scan, or a scan of a progressive picture.
TEST(DecodeImageTest, JpegsMayLackTheirEndMarkerAlone)
{
    Bytes values(64 * 64 * 3);
    Random random(11);
    for (unsigned char& value : values) {
        value = static_cast<unsigned char>(random.below(256));
    }
    for (const bool progressive : {false, true}) {
        const Bytes jpeg = encodeJpeg(64, 64, values, JpegColors::Color, progressive);
        const DecodedImage whole = decodeImage(jpeg), open = decodeImage(truncated(jpeg, 2));
        EXPECT_FALSE(whole.noEnd);
        EXPECT_TRUE(open.noEnd);
        EXPECT_EQ(open.rgba8, whole.rgba8);
        EXPECT_EQ(decodeImage(truncated(jpeg, 1)).rgba8, whole.rgba8);
        for (const std::size_t missing : {std::size_t{4}, std::size_t{40}, jpeg.size() / 2}) {
            expectBroken(truncated(jpeg, missing));
        }
    }
    const Bytes scan{0xff, 0xda}, jpeg = encodeJpeg(64, 64, values, JpegColors::Color, true);
    std::size_t scans = 0;
    for (auto at = std::search(jpeg.begin() + 2, jpeg.end(), scan.begin(), scan.end()); at != jpeg.end();
         at = std::search(at + 2, jpeg.end(), scan.begin(), scan.end())) {
        expectBroken(truncated(jpeg, static_cast<std::size_t>(jpeg.end() - at)));
        ++scans;
    }
    EXPECT_GT(scans, 4U);
}

TEST(DecodeImageTest, WebpsKeepAlpha)
{
    const Texels rgba{1, 2, 3, 4, 250, 251, 252, 253};
    const DecodedImage image = decodeImage(encodeWebp(2, 1, rgba));
    EXPECT_TRUE(image.hasAlpha);
    EXPECT_EQ(image.rgba8, rgba);
}

TEST(DecodeImageTest, BrokenImagesAreRefused)
{
    Bytes noise(64 * 64 * 3);
    Random random(7);
    for (unsigned char& value : noise) {
        value = static_cast<unsigned char>(random.below(256));
    }
    const Bytes png = encodePng(64, 64, noise), jpeg = encodeJpeg(64, 64, noise, JpegColors::Color);
    const Bytes progressive = encodeJpeg(64, 64, noise, JpegColors::Color, true);
    Bytes rgba(64 * 64 * 4, 255);
    std::copy(noise.begin(), noise.end(), rgba.begin());
    const Bytes webp = encodeWebp(64, 64, rgba);
    Bytes flipped = png;
    flipped[flipped.size() / 2] ^= 0x10U;
    Bytes largeJpeg = jpeg;  // 16384x16384 pixels
    const Bytes frame{0xff, 0xc0};
    const auto size = std::search(largeJpeg.begin(), largeJpeg.end(), frame.begin(), frame.end()) + 5;
    std::copy_n(Bytes{64, 0, 64, 0}.begin(), 4, size);
    PngFormat withText;
    withText.chunks = {{"tEXt", {'a', 0, 'b'}}};
    Bytes longText = encodePng(64, 64, noise, withText);
    longText[33] = 0x74;  // the first byte of that chunk's length
    Bytes animated{'R', 'I', 'F', 'F', 22, 0, 0, 0, 'W', 'E', 'B', 'P', 'V', 'P', '8', 'X', 10, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 3, 0, 0};
    struct Case {
        Bytes bytes;
        MessageId id;
        std::string value = {};  // any of the libraries' own reasons
    };
    const char *const withinChunk = "it ends within a chunk", *const early = "it ends early";
    const Case cases[] = {
        {{}, MessageId::UnknownFormat, "of an unknown kind (it is empty)"},
        {{'G', 'I', 'F', '8'}, MessageId::UnknownFormat, "of an unknown kind (it begins with 47 49 46 38)"},
        {{0, 0, 0, 28, 'f', 't', 'y', 'p', 'a', 'v', 'i', 'f'}, MessageId::UnknownFormat, "AVIF"},
        {{'D', 'D', 'S', ' ', 124}, MessageId::UnknownFormat, "DDS"},
        {{0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb}, MessageId::UnknownFormat, "of an unknown kind (it begins with ab 4b 54 58)"},
        {truncated(png, 100), MessageId::FileDamaged, withinChunk},
        {truncated(png, png.size() - 20), MessageId::FileDamaged, withinChunk},
        {longText, MessageId::FileDamaged, withinChunk},
        {flipped, MessageId::FileDamaged},
        {withPngSize(png, 0, 64), MessageId::FileDamaged},
        {withPngSize(png, 16385, 64), MessageId::TooLarge, "16385x64"},
        {withPngSize(png, 0x7fffffff, 0x7fffffff), MessageId::TooLarge, "2147483647x2147483647"},
        {withPngSize(png, 16384, 16384), MessageId::FileDamaged, early},
        {largeJpeg, MessageId::FileDamaged, early},
        {truncated(jpeg, 100), MessageId::FileDamaged},
        {truncated(progressive, 100), MessageId::FileDamaged},
        {truncated(jpeg, jpeg.size() - 10), MessageId::FileDamaged},
        {encodeJpeg(20000, 1, Bytes(20000, 1), JpegColors::Grey), MessageId::TooLarge, "20000x1"},
        {truncated(webp, 100), MessageId::FileDamaged, "broken WebP"},
        {truncated(webp, webp.size() - 14), MessageId::FileDamaged, "broken WebP"},
        {animated, MessageId::Unsupported, "animated WebP"},
    };
    for (const Case& c : cases) {
        expectRefusal<InputError>([&] { decodeImage(c.bytes); }, c.id, {.value = c.value});
    }
}

// Texts that swell to gigabytes, and private chunks, are skipped.
TEST(DecodeImageTest, ChunksThatNobodyReadsCostNothing)
{
    PngFormat format;
    for (int i = 0; i < 200; ++i) {
        format.chunks.emplace_back("tEXt", Bytes{'a', 0, 'b'});
        format.chunks.emplace_back("prVt", Bytes(1000, 1));
    }
    EXPECT_EQ(decodeImage(encodePng(1, 1, {1, 2, 3}, format)).rgba8, (Texels{1, 2, 3, 255}));
}

// Whatever bit of a file changes, it decodes or is refused.
TEST(DecodeImageTest, SurvivesMutants)
{
    Bytes values(24 * 24 * 3, 90);
    for (std::size_t i = 0; i < values.size(); i += 5) {
        values[i] = static_cast<unsigned char>(i);
    }
    const Bytes files[] = {encodePng(24, 24, values), encodeJpeg(24, 24, values, JpegColors::Color, true),
                           encodeWebp(24, 18, Bytes(values.begin(), values.begin() + 24 * 18 * 4))};
    Random random(11);
    std::size_t refused = 0;
    for (const Bytes& file : files) {
        for (int i = 0; i < 300; ++i) {
            Bytes mutant = file;
            for (int k = 0; k < 3; ++k) {
                mutant[random.below(static_cast<std::uint32_t>(mutant.size()))] = static_cast<unsigned char>(random.below(256));
            }
            refused += isRefused(mutant) ? 1U : 0U;
        }
    }
    EXPECT_GT(refused, 300U);
}

TEST(ShrinkImageTest, ColoursAreAveragedInLinearLight)
{
    DecodedImage image;
    image.width = 4;
    image.height = 1;
    image.rgba8 = {0, 0, 0, 0, 255, 255, 255, 100, 10, 20, 30, 40, 10, 20, 30, 40};
    const auto half = static_cast<std::uint8_t>(std::lround(255.0 * srgbFromLinear(0.5)));
    EXPECT_EQ(half, 188);
    EXPECT_EQ(shrinkImage(image, 2, true).rgba8, (Texels{half, half, half, 50, 10, 20, 30, 40}));
    EXPECT_EQ(shrinkImage(image, 2, false).rgba8, (Texels{128, 128, 128, 50, 10, 20, 30, 40}));
    EXPECT_EQ(shrinkImage(image, 4, true).rgba8, image.rgba8) << "it fits";
    image.rgba8.clear();
    image.rgba16 = {0, 0, 0, 0, 65535, 65535, 65535, 100, 1, 2, 3, 4, 1, 2, 3, 4};
    EXPECT_EQ(shrinkImage(image, 2, false).rgba16, (std::vector<std::uint16_t>{32768, 32768, 32768, 50, 1, 2, 3, 4}));
}

// Both sides are halved together, to one texel at least; the share that a texel has of each of three counts.
TEST(ShrinkImageTest, OddSidesAreWeightedByArea)
{
    DecodedImage image;
    image.width = 5;
    image.height = 1;
    for (const std::uint8_t value : Texels{10, 20, 60, 100, 200}) {
        image.rgba8.insert(image.rgba8.end(), {value, value, value, 255});
    }
    const DecodedImage small = shrinkImage(image, 3, false);
    EXPECT_EQ(small.width, 2U);
    EXPECT_EQ(small.height, 1U);
    EXPECT_EQ(small.rgba8, (Texels{24, 24, 24, 255, 132, 132, 132, 255}));  // (10 + 20 + 30) / 2.5, (30 + 100 + 200) / 2.5
    EXPECT_EQ(shrinkImage(image, 1, false).rgba8, (Texels{78, 78, 78, 255})) << "at once, not in steps that round";
}

}  // namespace
}  // namespace glim::test
