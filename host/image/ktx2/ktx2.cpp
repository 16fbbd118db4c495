#include "host/image/ktx2/ktx2.hpp"

#include "host/image/ktx2/basis_lz.hpp"
#include "host/image/ktx2/refuse_ktx2.hpp"
#include "host/image/ktx2/uastc.hpp"

#include <zstd.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <new>
#include <string_view>

namespace glim {
namespace {

using Bytes = std::span<const unsigned char>;

constexpr unsigned char kIdentifier[] = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};

// KTX 2.0 specification, section "File Structure": the identifier, the header, the extent of the global data and the levels' index.
struct FileHeader {
    std::uint32_t format, typeSize, width, height, depth, layers, faces, levels, scheme;
    std::uint32_t descriptorOffset, descriptorLength, keysOffset, keysLength;
};
struct Extent {
    std::uint64_t offset, length;
};
struct LevelEntry {
    Extent extent;
    std::uint64_t uncompressedLength;
};
constexpr std::size_t kGlobalAt = sizeof kIdentifier + sizeof(FileHeader), kLevelsAt = kGlobalAt + sizeof(Extent);
static_assert(kLevelsAt == 80 && sizeof(LevelEntry) == 24);

// Section "supercompressionScheme".
enum Scheme : std::uint32_t { kNone = 0, kBasisLz = 1, kZstandard = 2 };

enum class Coding { Etc1s, Uastc, Plain };

struct Format {
    Coding coding = Coding::Plain;
    std::uint32_t channels = 4;  // of plain texels
    bool hasAlpha = false;
    bool greenInAlpha = false;  // red stands in RGB and green in alpha
};

template <class Part>
Part readPart(Bytes bytes, std::size_t at)
{
    Part part;
    std::memcpy(&part, bytes.data() + at, sizeof part);
    return part;
}

Bytes findSection(Bytes file, const Extent& extent, const std::string& name)
{
    if (extent.offset > file.size() || extent.length > file.size() - extent.offset) {
        refuseKtx2(name + " is at", "byte " + std::to_string(extent.offset) + ", of " + std::to_string(extent.length) + " bytes",
                   "within " + std::to_string(file.size()) + " bytes");
    }
    return file.subspan(extent.offset, extent.length);
}

FileHeader readHeader(Bytes file)
{
    if (file.size() < kLevelsAt + sizeof(LevelEntry)) {
        refuseKtx2("it has", std::to_string(file.size()) + " bytes", std::to_string(kLevelsAt + sizeof(LevelEntry)) + " or more");
    }
    const auto header = readPart<FileHeader>(file, sizeof kIdentifier);
    checkImageSize("KTX2", header.width, header.height);
    if (header.depth != 0 || header.layers != 0 || header.faces != 1) {
        refuseKtx2Kind("of depth " + std::to_string(header.depth) + ", " + std::to_string(header.layers) + " layers and " +
                           std::to_string(header.faces) + " faces",
                       "a 2D picture (0, 0 and 1)");
    }
    const auto most = static_cast<std::uint32_t>(std::bit_width(std::max(header.width, header.height)));
    if (header.levels > most) {
        refuseKtx2("it has", std::to_string(header.levels) + " levels", "at most " + std::to_string(most));
    }
    return header;
}

// Sections "KTXorientation" and "KTXswizzle".
void checkKeys(Bytes keys)
{
    while (!keys.empty()) {
        const std::uint32_t length = keys.size() < 4 ? 0 : readPart<std::uint32_t>(keys, 0);
        if (length < 2 || length > keys.size() - 4) {
            refuseKtx2("one of its keys has", std::to_string(length) + " bytes",
                       "2 to " + std::to_string(std::max<std::size_t>(keys.size(), 6) - 4));
        }
        const std::string_view entry(reinterpret_cast<const char*>(keys.data()) + 4, length);
        const std::string_view key = entry.substr(0, entry.find('\0'));
        std::string_view value = entry.substr(std::min(key.size() + 1, entry.size()));
        value = value.substr(0, value.find('\0'));
        for (const auto& [name, only] : {std::pair{"KTXorientation", "rd"}, std::pair{"KTXswizzle", "rgba"}}) {
            if (key == name && value != only) {
                refuseKtx2Kind(std::string("whose ") + name + " is " + inQuotes(std::string(value)), inQuotes(only));
            }
        }
        keys = keys.subspan(std::min<std::size_t>(keys.size(), 4 + (length + 3) / 4 * 4));
    }
}

// Khronos Data Format Specification 1.3, sections "Basic Data Format Descriptor", "KHR_DF_MODEL_ETC1S" and "KHR_DF_MODEL_UASTC".
struct Descriptor {
    std::uint32_t totalSize, vendorAndType;
    std::uint16_t version, blockSize;
    std::uint8_t model, primaries, transfer, flags;
    std::uint8_t texelBlock[4], bytesPlane[8];
};
struct Sample {
    std::uint16_t bitOffset;
    std::uint8_t bitLength, channel;  // above the channel's four bits are qualifiers
    std::uint32_t position, lower, upper;
};
static_assert(sizeof(Descriptor) == 28 && sizeof(Sample) == 16);
constexpr unsigned kPremultiplied = 1, kModelEtc1s = 163, kModelUastc = 166;
constexpr unsigned kEtc1sRgb = 0, kEtc1sRed = 3, kEtc1sGreen = 4, kEtc1sAlpha = 15;
constexpr unsigned kUastcRgb = 0, kUastcRgba = 3, kUastcRed = 4, kUastcRedGreen = 5, kUastcRg = 6;

Format readFormat(const FileHeader& header, Bytes bytes)
{
    if (bytes.size() < sizeof(Descriptor) + sizeof(Sample)) {
        refuseKtx2("its data format descriptor has", std::to_string(bytes.size()) + " bytes",
                   std::to_string(sizeof(Descriptor) + sizeof(Sample)) + " or more");
    }
    const auto descriptor = readPart<Descriptor>(bytes, 0);
    constexpr std::size_t kFieldsBefore = sizeof descriptor.totalSize, kLeast = sizeof(Descriptor) + sizeof(Sample) - kFieldsBefore;
    if (descriptor.blockSize < kLeast || descriptor.blockSize > bytes.size() - kFieldsBefore) {
        refuseKtx2("the basic block of its data format descriptor has", std::to_string(descriptor.blockSize) + " bytes",
                   std::to_string(kLeast) + " to " + std::to_string(bytes.size() - kFieldsBefore));
    }
    if ((descriptor.flags & kPremultiplied) != 0) {
        refuseKtx2Kind("whose colours are multiplied by alpha", "colours that are not");
    }
    switch (header.format) {
    case 0: break;                                                // VK_FORMAT_UNDEFINED: the color model says it
    case 23:                                                      // R8G8B8_UNORM
    case 29: return {.coding = Coding::Plain, .channels = 3};     // R8G8B8_SRGB
    case 37:                                                      // R8G8B8A8_UNORM
    case 43: return {.coding = Coding::Plain, .hasAlpha = true};  // R8G8B8A8_SRGB
    default: refuseKtx2Kind("of Vulkan's format " + std::to_string(header.format), "ETC1S, UASTC, R8G8B8 or R8G8B8A8");
    }
    const auto channelOf = [&](std::size_t sample) {
        return readPart<Sample>(bytes, sizeof(Descriptor) + sample * sizeof(Sample)).channel & 15U;
    };
    const bool two = kFieldsBefore + descriptor.blockSize >= sizeof(Descriptor) + 2 * sizeof(Sample);
    const unsigned first = channelOf(0), second = two ? channelOf(1) : first;
    if (descriptor.model == kModelEtc1s && first == kEtc1sRgb && (!two || second == kEtc1sAlpha)) {
        return {.coding = Coding::Etc1s, .hasAlpha = two};
    }
    if (descriptor.model == kModelEtc1s && first == kEtc1sRed && (!two || second == kEtc1sGreen)) {
        return {.coding = Coding::Etc1s, .greenInAlpha = two};
    }
    if (descriptor.model == kModelUastc &&
        (first == kUastcRgb || first == kUastcRgba || first == kUastcRed || first == kUastcRedGreen || first == kUastcRg)) {
        return {.coding = Coding::Uastc, .hasAlpha = first == kUastcRgba, .greenInAlpha = first == kUastcRedGreen};
    }
    refuseKtx2Kind("of color model " + std::to_string(descriptor.model) + " and channel " + std::to_string(first),
                   "ETC1S (163) or UASTC (166), and a channel of theirs");
}

// The bytes of a level, from the first to the last.
class LevelReader {
public:
    LevelReader(Bytes level, bool compressed)
        : left_{level.data(), level.size(), 0},
          context_(compressed ? ZSTD_createDCtx() : nullptr)
    {
        if (compressed && !context_) {
            throw std::bad_alloc();
        }
    }

    void read(std::span<unsigned char> to)
    {
        if (inflate(to) < to.size()) {
            refuseKtx2("its level 0 has", std::to_string(left_.size) + " bytes of Zstandard", "more");
        }
    }
    // Refuses what follows.
    void finish()
    {
        unsigned char more = 0;
        if (context_ && inflate({&more, 1}) != 0) {
            refuseKtx2("its level 0 has", "more bytes of Zstandard", "the uncompressed length of its index");
        }
    }

private:
    // How many bytes there were, at most to.size().
    std::size_t inflate(std::span<unsigned char> to)
    {
        ZSTD_outBuffer out{to.data(), to.size(), 0};
        if (!context_) {
            std::memcpy(out.dst, static_cast<const unsigned char*>(left_.src) + left_.pos, out.size);
            left_.pos += out.size;
            return out.size;
        }
        for (bool going = true; going && out.pos < out.size;) {
            const std::size_t before = left_.pos + out.pos, result = ZSTD_decompressStream(context_.get(), &out, &left_);
            if (ZSTD_isError(result) != 0) {
                refuseKtx2("its level 0 is", std::string("no Zstandard (") + ZSTD_getErrorName(result) + ")", "that");
            }
            going = left_.pos + out.pos > before;
        }
        return out.pos;
    }

    struct Free {
        void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
    };
    ZSTD_inBuffer left_;
    std::unique_ptr<ZSTD_DCtx, Free> context_;
};

std::uint32_t countBlocks(std::uint32_t side) { return (side + 3) / 4; }

DecodedImage makePicture(const FileHeader& header, const Format& format)
{
    DecodedImage image;
    image.width = header.width;
    image.height = header.height;
    image.hasAlpha = format.hasAlpha;
    image.rgba8.resize(std::size_t{header.width} * header.height * 4);
    return image;
}

// Calls put(texel of the image, x and y within the block) for each texel of the block that lies in the image.
template <class Put>
void putBlock(DecodedImage& image, std::uint32_t blockX, std::uint32_t blockY, const Put& put)
{
    const std::uint32_t columns = std::min(4U, image.width - 4 * blockX), rows = std::min(4U, image.height - 4 * blockY);
    for (std::uint32_t y = 0; y < rows; ++y) {
        std::uint8_t* const row = image.rgba8.data() + ((std::size_t{4} * blockY + y) * image.width + std::size_t{4} * blockX) * 4;
        for (std::uint32_t x = 0; x < columns; ++x) {
            put(row + 4 * std::size_t{x}, x, y);
        }
    }
}

DecodedImage decodeEtc1s(const FileHeader& header, const Format& format, Bytes level, Bytes global)
{
    const BasisLz codebooks(global, std::max(header.levels, 1U));
    const std::uint32_t columns = countBlocks(header.width), rows = countBlocks(header.height);
    const auto decode = [&](const BasisLz::Slice& slice, const std::string& name) {
        return codebooks.decodeSlice(findSection(level, {slice.offset, slice.length}, name), columns, rows, name);
    };
    const bool two = format.hasAlpha || format.greenInAlpha;
    const std::vector<EtcBlock> colors = decode(codebooks.color(), "its first slice");
    const std::vector<EtcBlock> alphas = two ? decode(codebooks.alpha(), "its second slice") : std::vector<EtcBlock>();
    DecodedImage image = makePicture(header, format);
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const auto x = static_cast<std::uint32_t>(i % columns), y = static_cast<std::uint32_t>(i / columns);
        putBlock(image, x, y, [&](std::uint8_t* texel, std::uint32_t column, std::uint32_t row) {
            std::memcpy(texel, codebooks.texel(colors[i], column, row).data(), 4);
            if (two) {
                texel[3] = codebooks.texel(alphas[i], column, row)[1];  // its three channels are equal
            }
        });
    }
    return image;
}

DecodedImage decodeUastcLevel(const FileHeader& header, const Format& format, LevelReader& level)
{
    DecodedImage image = makePicture(header, format);
    std::vector<unsigned char> row(std::size_t{countBlocks(header.width)} * kUastcBlockBytes);
    UastcTexels texels;
    for (std::uint32_t y = 0; y < countBlocks(header.height); ++y) {
        level.read(row);
        for (std::uint32_t x = 0; x < countBlocks(header.width); ++x) {
            const Bytes block = Bytes(row).subspan(std::size_t{x} * kUastcBlockBytes);
            if (!decodeUastc(block.first<kUastcBlockBytes>(), texels)) {
                refuseKtx2("its block " + std::to_string(x) + ", " + std::to_string(y) + " has", "a reserved mode or pattern",
                           "one of UASTC's");
            }
            putBlock(image, x, y, [&texels](std::uint8_t* texel, std::uint32_t column, std::uint32_t line) {
                std::memcpy(texel, texels[4 * std::size_t{line} + column].data(), 4);
            });
        }
    }
    return image;
}

DecodedImage readPlainLevel(const FileHeader& header, const Format& format, LevelReader& level)
{
    DecodedImage image = makePicture(header, format);
    std::vector<unsigned char> row(std::size_t{header.width} * format.channels);
    for (std::uint32_t y = 0; y < header.height; ++y) {
        level.read(row);
        std::uint8_t* const to = image.rgba8.data() + std::size_t{y} * header.width * 4;
        for (std::size_t x = 0; x < header.width; ++x) {
            to[4 * x + 3] = 255;
            std::memcpy(to + 4 * x, row.data() + x * format.channels, format.channels);
        }
    }
    return image;
}

// What glTF calls a texture of red and green has them where it reads them.
void moveGreen(DecodedImage& image)
{
    for (std::size_t i = 0; i < image.rgba8.size(); i += 4) {
        image.rgba8[i + 1] = image.rgba8[i + 3];
        image.rgba8[i + 2] = 0;
        image.rgba8[i + 3] = 255;
    }
}

// Of UASTC and plain texels, whose size follows from that of the picture.
LevelReader openLevel(const FileHeader& header, const Format& format, const LevelEntry& entry, Bytes level)
{
    const std::uint64_t size = format.coding == Coding::Uastc
                                   ? std::uint64_t{countBlocks(header.width)} * countBlocks(header.height) * kUastcBlockBytes
                                   : std::uint64_t{header.width} * header.height * format.channels;
    const bool compressed = header.scheme == kZstandard;
    const std::uint64_t promised = compressed ? entry.uncompressedLength : entry.extent.length;
    if (promised != size) {
        refuseKtx2("its level 0 has", std::to_string(promised) + " bytes", std::to_string(size));
    }
    // A block of Zstandard has at least 4 bytes and stands for at most 128 KiB (RFC 8878, section 3.1.1.2): an index that promises more
    // costs no memory.
    constexpr std::uint64_t kMaxInflated = 32768;
    if (compressed && level.size() * kMaxInflated < size) {
        refuseKtx2("its level 0 has", std::to_string(level.size()) + " bytes of Zstandard", "more");
    }
    return {level, compressed};
}

}  // namespace

bool isKtx2(Bytes bytes)
{
    return bytes.size() >= sizeof kIdentifier && std::equal(std::begin(kIdentifier), std::end(kIdentifier), bytes.begin());
}

DecodedImage decodeKtx2(Bytes file)
{
    const FileHeader header = readHeader(file);
    const Format format =
        readFormat(header, findSection(file, {header.descriptorOffset, header.descriptorLength}, "its data format descriptor"));
    checkKeys(findSection(file, {header.keysOffset, header.keysLength}, "its list of keys"));
    const auto entry = readPart<LevelEntry>(file, kLevelsAt);
    const Bytes levelBytes = findSection(file, entry.extent, "its level 0");
    const bool basis = format.coding == Coding::Etc1s;
    if (basis ? header.scheme != kBasisLz : header.scheme != kNone && header.scheme != kZstandard) {
        refuseKtx2Kind("of supercompression " + std::to_string(header.scheme), basis ? "BasisLZ (1)" : "none (0) or Zstandard (2)");
    }
    DecodedImage image;
    if (basis) {
        image = decodeEtc1s(header, format, levelBytes, findSection(file, readPart<Extent>(file, kGlobalAt), "its global data"));
    } else {
        LevelReader level = openLevel(header, format, entry, levelBytes);
        image = format.coding == Coding::Uastc ? decodeUastcLevel(header, format, level) : readPlainLevel(header, format, level);
        level.finish();
    }
    if (format.greenInAlpha) {
        moveGreen(image);
    }
    return image;
}

}  // namespace glim
