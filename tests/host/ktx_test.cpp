// KTX2 textures: what they decode to, by another decoder (ktx2/make.py), and what is refused.
#include "host/digest.hpp"
#include "host/image/decode_image.hpp"
#include "host/image/ktx2/huffman.hpp"
#include "places.h"
#include "tests/support/encode_images.hpp"
#include "tests/support/expect_message.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace glim::test {
namespace {

Bytes readTexture(const std::string& name)
{
    std::ifstream file(std::filesystem::path(GLIM_SOURCE_DIR "/tests/host/ktx2") / (name + ".ktx2"), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// Where the fields of the header are, in bytes.
enum Field : std::size_t {
    kFormat = 12,
    kWidth = 20,
    kHeight = 24,
    kDepth = 28,
    kLayers = 32,
    kFaces = 36,
    kLevels = 40,
    kScheme = 44,
    kDescriptor = 48,
    kKeys = 56,
    kGlobal = 64,
    kLevel = 80,
    kUncompressed = 96
};

std::uint32_t numberAt(const Bytes& bytes, std::size_t at)
{
    return bytes.at(at) | bytes.at(at + 1) << 8U | bytes.at(at + 2) << 16U | std::uint32_t{bytes.at(at + 3)} << 24U;
}

Bytes with(Bytes bytes, std::size_t at, std::uint32_t number)
{
    for (std::size_t i = 0; i < 4; ++i) {
        bytes.at(at + i) = static_cast<unsigned char>(number >> 8 * i);
    }
    return bytes;
}

Bytes withByte(Bytes bytes, std::size_t at, unsigned char byte)
{
    bytes.at(at) = byte;
    return bytes;
}

// Its only key, in place of the one that says who wrote the file.
Bytes withKey(Bytes bytes, const std::string& key, const std::string& value)
{
    const std::string entry = key + '\0' + value + '\0';
    const std::size_t at = numberAt(bytes, kKeys);
    EXPECT_LE(entry.size() + 4, numberAt(bytes, kKeys + 4));
    std::copy(entry.begin(), entry.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at) + 4);
    return with(with(bytes, at, static_cast<std::uint32_t>(entry.size())), kKeys + 4, static_cast<std::uint32_t>(entry.size() + 4));
}

// Texels of a 2x2 picture without compression.
Bytes makePlain(std::uint32_t format, const Bytes& texels)
{
    Bytes plain = readTexture("uastc_modes");
    const std::size_t level = numberAt(plain, kLevel);
    plain.resize(level);
    plain.insert(plain.end(), texels.begin(), texels.end());
    plain = with(with(with(plain, kFormat, format), kWidth, 2), kHeight, 2);
    return with(plain, kLevel + 8, static_cast<std::uint32_t>(texels.size()));
}

// Bits, the first one lowest.
class BitWriter {
public:
    BitWriter& add(unsigned count, std::uint32_t value)
    {
        for (unsigned i = 0; i < count; ++i, ++size_) {
            if (size_ % 8 == 0) {
                bytes_.push_back(0);
            }
            bytes_.back() |= static_cast<unsigned char>((value >> i & 1U) << size_ % 8);
        }
        return *this;
    }
    const Bytes& bytes() const { return bytes_; }

private:
    Bytes bytes_;
    std::size_t size_ = 0;
};

TEST(Ktx2Test, TexelsAreThoseOfAnotherDecoder)
{
    struct Case {
        const char* name;
        std::uint32_t width, height;
        bool hasAlpha;
        const char* digest;  // SHA-256 of the RGBA
    };
    for (const Case& c : {
             Case{"etc1s_alpha", 20, 12, true, "5b7553dd1796a8195ab2ee85fa23510e65d4c5f8badf0e0b71aadf3bc5270f6e"},
             Case{"etc1s_flat", 64, 64, false, "ea3dfc6fb928506e99205b09d27f1656d8e5d41177eb95e4fcbc856df308b9f3"},
             Case{"etc1s_grey", 8, 8, false, "a65ac2330aedb94f6d901e77ba40644c652e7ce891e07a2bf39e96d8e8caca2b"},
             Case{"etc1s_noisy", 32, 32, false, "5da411a9a7172ba06257924aa879fc9000e0444a65df739618c5d7e786ddda2e"},
             Case{"etc1s_odd", 13, 7, false, "a7ba21696e4c11ef72f40080bba2630e44c7e651f06621d8be1fc3dbd5244261"},
             Case{"uastc_block", 4, 4, false, "ae9de01b4648c5957d688fcd06d3747557fdec4a2e876f8d83d536ab5f5fe1c1"},
             Case{"uastc_flat", 64, 64, false, "ba0fc5c79ef4917635ee567a421a9015e0d82485a15464817d50a3f8d7043e89"},
             Case{"uastc_modes", 64, 20, true, "22606ae31840b9833bac4f0afa83aa27ba68ab6d0ef2c67e0423b22407a70104"},
             Case{"uastc_odd", 13, 7, false, "5dd5e56194c4c538f6846c2b3d896bc69e14ef0eb6bc3ba98615cbb00af22b1e"},
             Case{"uastc_zstd", 20, 12, true, "3ff3f2b8a38cc8d558cbd74137d65ba089c60e24f14cbd965cb46457510115f6"},
         }) {
        SCOPED_TRACE(c.name);
        const DecodedImage image = decodeImage(readTexture(c.name));
        EXPECT_EQ(image.width, c.width);
        EXPECT_EQ(image.height, c.height);
        EXPECT_EQ(image.hasAlpha, c.hasAlpha);
        Digest digest;
        digest.add(image.rgba8);
        EXPECT_EQ(digest.finish(), c.digest);
    }
}

TEST(Ktx2Test, PlainTexelsAreTakenAsTheyAre)
{
    using Texels = std::vector<std::uint8_t>;
    for (const std::uint32_t format : {23U, 29U}) {
        const DecodedImage image = decodeImage(makePlain(format, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
        EXPECT_FALSE(image.hasAlpha);
        EXPECT_EQ(image.rgba8, (Texels{1, 2, 3, 255, 4, 5, 6, 255, 7, 8, 9, 255, 10, 11, 12, 255}));
    }
    const Bytes texels{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
    for (const std::uint32_t format : {37U, 43U}) {
        EXPECT_TRUE(decodeImage(makePlain(format, texels)).hasAlpha);
        EXPECT_EQ(decodeImage(makePlain(format, texels)).rgba8, texels);
    }
}

// Channels as KHR_texture_basisu has them: the second slice is green, and so is alpha of UASTC.
TEST(Ktx2Test, TexturesOfRedAndGreenHaveThemInTheirPlaces)
{
    const Bytes slices = readTexture("etc1s_alpha"), blocks = readTexture("uastc_modes");
    const std::size_t ofSlices = numberAt(slices, kDescriptor) + 28, ofBlocks = numberAt(blocks, kDescriptor) + 28;
    for (const auto& [rgba, redGreen] : {
             std::pair{slices, withByte(withByte(slices, ofSlices + 3, 3), ofSlices + 16 + 3, 4)},
             std::pair{blocks, withByte(blocks, ofBlocks + 3, 5)},
         }) {
        const DecodedImage from = decodeImage(rgba), to = decodeImage(redGreen);
        EXPECT_FALSE(to.hasAlpha);
        ASSERT_EQ(to.rgba8.size(), from.rgba8.size());
        for (std::size_t i = 0; i < to.rgba8.size(); i += 4) {
            const std::vector<int> texel(&to.rgba8[i], &to.rgba8[i] + 4);
            EXPECT_EQ(texel, (std::vector<int>{from.rgba8[i], from.rgba8[i + 3], 0, 255}));
        }
    }
}

TEST(Ktx2Test, OtherOrientationsAreRefused)
{
    const Bytes texture = readTexture("etc1s_alpha");
    EXPECT_EQ(decodeImage(withKey(texture, "KTXorientation", "rd")).rgba8, decodeImage(texture).rgba8);
    EXPECT_EQ(decodeImage(withKey(texture, "KTXswizzle", "rgba")).rgba8, decodeImage(texture).rgba8);
    for (const auto& [bytes, value, expected] : {
             std::tuple{withKey(texture, "KTXorientation", "ru"), "whose KTXorientation is \"ru\"", "\"rd\""},
             std::tuple{withKey(texture, "KTXswizzle", "bgra"), "whose KTXswizzle is \"bgra\"", "\"rgba\""},
         }) {
        expectRefusal<InputError>([&] { decodeImage(bytes); }, MessageId::Unsupported, {.value = value, .expected = expected});
    }
}

TEST(Ktx2Test, OtherKindsAreRefused)
{
    const Bytes etc1s = readTexture("etc1s_alpha"), uastc = readTexture("uastc_zstd");
    const std::size_t descriptor = numberAt(etc1s, kDescriptor), global = numberAt(etc1s, kGlobal);
    struct Case {
        Bytes bytes;
        MessageId id;
        std::string value;
    };
    for (const Case& c : {
             Case{with(etc1s, kWidth, 0), MessageId::TooLarge, "0x12"},
             Case{with(etc1s, kHeight, 0x80000000), MessageId::TooLarge, "20x2147483648"},
             Case{with(etc1s, kDepth, 2), MessageId::Unsupported, "of depth 2, 0 layers and 1 faces"},
             Case{with(etc1s, kLayers, 2), MessageId::Unsupported, "of depth 0, 2 layers and 1 faces"},
             Case{with(etc1s, kFaces, 6), MessageId::Unsupported, "of depth 0, 0 layers and 6 faces"},
             Case{with(etc1s, kFormat, 147), MessageId::Unsupported, "of Vulkan's format 147"},
             Case{with(etc1s, kScheme, 2), MessageId::Unsupported, "of supercompression 2"},
             Case{with(uastc, kScheme, 1), MessageId::Unsupported, "of supercompression 1"},
             Case{with(uastc, kScheme, 3), MessageId::Unsupported, "of supercompression 3"},
             Case{withByte(etc1s, descriptor + 12, 167), MessageId::Unsupported, "of color model 167 and channel 0"},
             Case{withByte(etc1s, descriptor + 28 + 3, 7), MessageId::Unsupported, "of color model 163 and channel 7"},
             Case{withByte(etc1s, descriptor + 15, 1), MessageId::Unsupported, "whose colours are multiplied by alpha"},
             Case{withByte(etc1s, global + 20, 2), MessageId::Unsupported, "that begins with a P-frame of a video"},
         }) {
        expectRefusal<InputError>([&] { decodeImage(c.bytes); }, c.id, {.value = c.value});
    }
}

TEST(Ktx2Test, WrongLengthsAreRefused)
{
    const Bytes etc1s = readTexture("etc1s_alpha"), uastc = readTexture("uastc_zstd"), bare = readTexture("uastc_odd");
    const auto global = numberAt(etc1s, kGlobal), end = static_cast<std::uint32_t>(etc1s.size());
    struct Case {
        Bytes bytes;
        std::string value, expected;
    };
    for (const Case& c : {
             Case{with(etc1s, kLevels, 6), "6 levels", "at most 5"},
             Case{with(etc1s, kLevels, 0xffffffff), "4294967295 levels", "at most 5"},
             Case{with(etc1s, kDescriptor + 4, 43), "43 bytes", "44 or more"},
             Case{with(etc1s, numberAt(etc1s, kDescriptor) + 8, 2 + (60U << 16U)), "60 bytes", "40 to 56"},
             Case{with(etc1s, kDescriptor, end), "byte 870, of 60 bytes", "within 870 bytes"},
             Case{with(etc1s, kKeys + 4, 3), "0 bytes", "2 to 2"},
             Case{with(etc1s, numberAt(etc1s, kKeys), 0xfffffffe), "4294967294 bytes", "2 to 32"},
             Case{with(bare, numberAt(bare, kDescriptor) + 8, 2), "0 bytes", "40 to 40"},
             Case{with(etc1s, kGlobal + 8, 119), "119 bytes", "120 or more"},
             Case{with(etc1s, kGlobal + 8, 516), "516 bytes", "517"},
             Case{with(etc1s, kGlobal + 4, 1), "byte 4294967592, of 517 bytes", "within 870 bytes"},
             Case{with(etc1s, global + 4, 0xffffffff), "517 bytes", "4294967667"},  // the endpoints' length
             Case{with(etc1s, global, 0), "0 endpoints and 0 selectors", "1 or more"},
             Case{with(etc1s, global + 24, 16), "byte 16, of 14 bytes", "within 29 bytes"},  // the first slice's offset
             Case{with(etc1s, global + 28, 100), "100 bytes", "29"},
             Case{with(etc1s, global + 28, 1), "1 bytes", "more"},
             Case{with(bare, kWidth, 17), "128 bytes", "160"},
             Case{with(uastc, kWidth, 24), "240 bytes", "288"},
             Case{with(uastc, kUncompressed, 0), "0 bytes", "240"},
             Case{with(uastc, kUncompressed + 4, 1), "4294967536 bytes", "240"},
         }) {
        SCOPED_TRACE(c.value);
        expectRefusal<InputError>([&] { decodeImage(c.bytes); }, MessageId::FileDamaged, {.expected = c.expected});
        try {
            decodeImage(c.bytes);
        } catch (const InputError& error) {
            EXPECT_NE(error.message().value.find(c.value), std::string::npos) << error.what();
        }
    }
}

TEST(Ktx2Test, NoBeginningOfATextureIsOne)
{
    for (const char* name : {"etc1s_alpha", "uastc_odd", "uastc_zstd"}) {
        const Bytes whole = readTexture(name);
        for (std::size_t size = 12; size < whole.size(); ++size) {
            expectRefusal<InputError>([&] { decodeImage(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))); },
                                      MessageId::FileDamaged);
        }
    }
}

// An index that promises a gibibyte of 60 bytes of Zstandard is refused before anything is allocated.
TEST(Ktx2Test, BombsOfZstandardAreRefused)
{
    const Bytes texture = readTexture("uastc_zstd"), large = with(with(texture, kWidth, 16384), kHeight, 16384);
    expectRefusal<InputError>([&] { decodeImage(with(large, kUncompressed, 16384 * 16384)); }, MessageId::FileDamaged,
                              {.value = std::to_string(numberAt(texture, kLevel + 8)) + " bytes of Zstandard", .expected = "more"});
    // And the stream may hold more than the index says.
    const Bytes small = with(with(texture, kHeight, 8), kUncompressed, 160);
    expectRefusal<InputError>([&] { decodeImage(small); }, MessageId::FileDamaged, {.value = "more bytes of Zstandard"});
    const Bytes taller = with(with(texture, kHeight, 16), kUncompressed, 320);
    expectRefusal<InputError>([&] { decodeImage(taller); }, MessageId::FileDamaged, {.expected = "more"});
    const Bytes noise = withByte(texture, numberAt(texture, kLevel), 0);
    expectRefusal<InputError>([&] { decodeImage(noise); }, MessageId::FileDamaged, {.value = "no Zstandard (Unknown frame descriptor)"});
}

TEST(Ktx2Test, ReservedBlocksOfUastcAreRefused)
{
    const Bytes texture = readTexture("uastc_odd");
    const std::size_t second = numberAt(texture, kLevel) + 16;
    Bytes pattern = withByte(withByte(texture, second, 0x1d), second + 2, 0xe0);  // mode 2, whose pattern begins at bit 20
    pattern.at(second + 3) |= 1U;
    for (const Bytes& bytes : {withByte(texture, second, 0x45), withByte(withByte(pattern, second + 2, 0xf0), second + 3, 0xff)}) {
        expectRefusal<InputError>([&] { decodeImage(bytes); }, MessageId::FileDamaged, {.value = "a reserved mode or pattern"});
    }
}

TEST(Ktx2Test, SelectorsBeginWithZeros)
{
    const Bytes texture = readTexture("etc1s_alpha");
    const std::size_t global = numberAt(texture, kGlobal), selectors = global + 120 + numberAt(texture, global + 4);
    const auto reserved = static_cast<unsigned char>(texture.at(selectors) | 2U);
    expectRefusal<InputError>([&] { decodeImage(withByte(texture, selectors, reserved)); }, MessageId::FileDamaged,
                              {.value = "the bits 2", .expected = "0"});
}

std::vector<std::uint32_t> decodeAll(const HuffmanTable& table, const Bytes& bytes, std::size_t count)
{
    BitReader bits(bytes, "its bits");
    std::vector<std::uint32_t> symbols;
    while (symbols.size() < count) {
        symbols.push_back(table.decode(bits));
    }
    return symbols;
}

// The example of RFC 1951, section 3.2.2: the codes of A to H are 010, 011, 100, 101, 110, 00, 1110 and 1111.
TEST(Ktx2HuffmanTest, CodesAreThoseOfDeflate)
{
    const HuffmanTable table(std::vector<std::uint8_t>{3, 3, 3, 3, 3, 2, 4, 4}, "x");
    BitWriter bits;
    for (const char* code : {"010", "00", "1111", "110", "1110", "011"}) {
        for (; *code != '\0'; ++code) {
            bits.add(1, *code == '1' ? 1 : 0);
        }
    }
    EXPECT_EQ(decodeAll(table, bits.bytes(), 6), (std::vector<std::uint32_t>{0, 5, 7, 4, 6, 1}));
}

// Each code but the last is ones and a zero.
TEST(Ktx2HuffmanTest, CodesHaveUpToSixteenBits)
{
    std::vector<std::uint8_t> lengths;
    for (std::uint8_t length = 1; length <= 16; ++length) {
        lengths.push_back(length);
    }
    lengths.push_back(16);
    BitWriter bits;
    std::vector<std::uint32_t> symbols;
    for (std::uint32_t symbol = 0; symbol <= 16; ++symbol) {
        bits.add(std::min(symbol + 1, 16U), (1U << symbol) - 1);
        symbols.push_back(symbol);
    }
    EXPECT_EQ(decodeAll(HuffmanTable(lengths, "x"), bits.bytes(), symbols.size()), symbols);
    EXPECT_THROW(decodeAll(HuffmanTable(lengths, "x"), bits.bytes(), symbols.size() + 2), InputError) << "the bits have ended";
}

TEST(Ktx2HuffmanTest, CodesMustFillTheirTree)
{
    const auto build = [](const std::vector<std::uint8_t>& lengths) { return HuffmanTable(lengths, "its tables"); };
    expectRefusal<InputError>([&] { build({1, 1, 1}); }, MessageId::FileDamaged, {.value = "98304/65536 of its codes"});
    expectRefusal<InputError>([&] { build({2, 2, 2}); }, MessageId::FileDamaged, {.value = "49152/65536 of its codes"});
    expectRefusal<InputError>([&] { build({0, 0}); }, MessageId::FileDamaged, {.value = "0/65536 of its codes"});
    EXPECT_EQ(decodeAll(build({0, 1}), {0}, 2), (std::vector<std::uint32_t>{1, 1})) << "a single code may be of one bit";
    EXPECT_THROW(decodeAll(build({0, 1}), {1}, 1), InputError);
    EXPECT_THROW(decodeAll(HuffmanTable(), {0, 0, 0, 0}, 1), InputError) << "no symbol at all";
}

// A table of `symbols`, whose code lengths 1, 17 and 19 have the codes 00, 01 and 10, and 20 has 11.
BitWriter beginTable(std::uint32_t symbols)
{
    BitWriter bits;
    bits.add(14, symbols).add(5, 21);
    for (const int length : {17, 18, 19, 20, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15, 16}) {
        bits.add(3, length == 1 || length == 17 || length == 19 || length == 20 ? 2 : 0);
    }
    return bits;
}

TEST(Ktx2HuffmanTest, RunsStayWithinTheirTable)
{
    const auto read = [](const BitWriter& bits) {
        BitReader reader(bits.bytes(), "its tables");
        return readHuffmanTable(reader);
    };
    constexpr unsigned kOne = 0, kZeros = 2, kRepeats = 1, kManyRepeats = 3;  // as bits, the first one lowest
    EXPECT_EQ(decodeAll(read(beginTable(5).add(2, kOne).add(2, kZeros).add(3, 0).add(2, kOne)), {2}, 2),
              (std::vector<std::uint32_t>{0, 4}));
    struct Case {
        BitWriter bits;
        std::string value;
    };
    for (const Case& c : {
             Case{beginTable(9).add(2, kRepeats).add(2, 0), "a run of 3 lengths after 0"},
             Case{beginTable(9).add(2, kZeros).add(3, 0).add(2, kManyRepeats).add(7, 0), "a run of 7 lengths after 3"},
             Case{beginTable(4).add(2, kOne).add(2, kZeros).add(3, 1), "a run of 4 lengths after 1"},
             Case{beginTable(9).add(2, kOne).add(2, kManyRepeats).add(7, 127), "a run of 134 lengths after 1"},
             Case{BitWriter().add(14, 9).add(5, 22), "22 lengths of lengths"},
             Case{BitWriter().add(14, 9).add(5, 0), "0 lengths of lengths"},
         }) {
        expectRefusal<InputError>([&] { read(c.bits); }, MessageId::FileDamaged, {.value = c.value});
    }
}

}  // namespace
}  // namespace glim::test
