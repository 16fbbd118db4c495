#include "host/image/decode_image.hpp"

#include "host/error.hpp"
#include "host/image/jpeg_errors.hpp"
#include "host/image/ktx2/ktx2.hpp"

#include <png.h>
#include <webp/decode.h>

#include <algorithm>
#include <cstring>

#include <jerror.h>

namespace glim {
namespace {

using Bytes = std::span<const unsigned char>;

bool startsWith(Bytes bytes, std::string_view magic, std::size_t at = 0)
{
    return bytes.size() >= at + magic.size() && std::memcmp(bytes.data() + at, magic.data(), magic.size()) == 0;
}

// Whether a chunk is longer than the file. libpng allocates what the length says, of texts for example, even beyond its limit.
bool endsWithinChunk(Bytes png)
{
    constexpr std::size_t kSignature = 8, kFrame = 12;  // length, type and checksum
    for (Bytes left = png.subspan(kSignature); left.size() >= kFrame;) {
        const std::size_t length = std::size_t{left[0]} << 24U | std::size_t{left[1]} << 16U | std::size_t{left[2]} << 8U | left[3];
        if (startsWith(left, "IEND", 4)) {
            return false;
        }
        if (length > left.size() - kFrame) {
            return true;
        }
        left = left.subspan(kFrame + length);
    }
    return false;
}

// What libpng reads from, and what it says; libpng leaves by longjmp, past no destructor of these.
struct PngSource {
    Bytes left;
    std::string error;
};

void readPng(png_structp png, png_bytep to, png_size_t count)
{
    auto& source = *static_cast<PngSource*>(png_get_io_ptr(png));
    if (source.left.size() < count) {
        png_error(png, "it ends early");
    }
    std::memcpy(to, source.left.data(), count);
    source.left = source.left.subspan(count);
}

void keepPngError(png_structp png, png_const_charp message)
{
    static_cast<PngSource*>(png_get_error_ptr(png))->error = message;
    png_longjmp(png, 1);
}

void ignorePngWarning(png_structp /*png*/, png_const_charp /*message*/) {}

class PngReader {
public:
    explicit PngReader(PngSource& source)
        : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, keepPngError, ignorePngWarning)),
          info_(png_create_info_struct(png_))
    {
        constexpr png_alloc_size_t kMaxChunk = png_alloc_size_t{64} << 20;
        png_set_user_limits(png_, 0x7fffffff, 0x7fffffff);  // sizes are refused with a sentence of ours
        png_set_chunk_cache_max(png_, 4);                   // of texts and suggested palettes, which nobody reads
        png_set_chunk_malloc_max(png_, kMaxChunk);
        png_set_read_fn(png_, &source, readPng);
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    png_structp png() { return png_; }
    png_infop info() { return info_; }

private:
    png_structp png_;
    png_infop info_;
};

// False if libpng has given up.
bool readPngHeader(PngReader& reader)
{
    if (setjmp(png_jmpbuf(reader.png())) != 0) {
        return false;
    }
    png_read_info(reader.png(), reader.info());
    return true;
}

bool readPngRows(PngReader& reader, std::vector<png_bytep>& rows)
{
    if (setjmp(png_jmpbuf(reader.png())) != 0) {
        return false;
    }
    png_read_image(reader.png(), rows.data());
    png_read_end(reader.png(), nullptr);
    return true;
}

bool expandPng(PngReader& reader, bool wide)
{
    if (setjmp(png_jmpbuf(reader.png())) != 0) {
        return false;
    }
    png_set_expand(reader.png());  // palettes, few bits and a transparent colour
    png_set_gray_to_rgb(reader.png());
    png_set_add_alpha(reader.png(), wide ? 0xffffU : 0xffU, PNG_FILLER_AFTER);
    if (wide) {
        png_set_swap(reader.png());
    }
    png_set_interlace_handling(reader.png());
    png_read_update_info(reader.png(), reader.info());
    return true;
}

DecodedImage decodePng(Bytes bytes)
{
    PngSource source{bytes, ""};
    PngReader reader(source);
    const auto require = [&source](bool good) {
        if (!good) {
            throw InputError(MessageId::FileDamaged, {"is a broken PNG (", part::value(source.error), ")"});
        }
    };
    if (endsWithinChunk(bytes)) {
        source.error = "it ends within a chunk";
        require(false);
    }
    require(readPngHeader(reader));
    DecodedImage image;
    image.width = png_get_image_width(reader.png(), reader.info());
    image.height = png_get_image_height(reader.png(), reader.info());
    checkImageSize("PNG", image.width, image.height);
    const bool wide = png_get_bit_depth(reader.png(), reader.info()) == 16;
    image.hasAlpha = (png_get_color_type(reader.png(), reader.info()) & PNG_COLOR_MASK_ALPHA) != 0 ||
                     png_get_valid(reader.png(), reader.info(), PNG_INFO_tRNS) != 0;
    // No byte of deflate stands for more than 1032 others: a header that promises more costs no memory.
    constexpr std::uint64_t kMaxDeflated = 1032;
    if (bytes.size() * kMaxDeflated < png_get_rowbytes(reader.png(), reader.info()) * std::uint64_t{image.height}) {
        source.error = "it ends early";
        require(false);
    }
    require(expandPng(reader, wide));
    const std::size_t rowBytes = std::size_t{image.width} * (wide ? 8 : 4), bytesInAll = rowBytes * image.height;
    wide ? image.rgba16.resize(bytesInAll / 2) : image.rgba8.resize(bytesInAll);
    auto* const first = wide ? reinterpret_cast<png_bytep>(image.rgba16.data()) : image.rgba8.data();
    std::vector<png_bytep> rows;
    for (std::uint32_t y = 0; y < image.height; ++y) {
        rows.push_back(first + y * rowBytes);
    }
    require(readPngRows(reader, rows));
    return image;
}

// Some warnings mean that a part of the picture is made up. Others, as of bytes between markers, hold for files that show well.
void leaveOnDamage(j_common_ptr jpeg, int level)
{
    const int code = jpeg->err->msg_code;
    if (level < 0 && (code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE || code == JWRN_ARITH_BAD_CODE)) {
        leaveJpeg(jpeg);
    }
    if (level < 0 && code == JWRN_JPEG_EOF) {
        reinterpret_cast<JpegErrors*>(jpeg->err)->noEnd = true;
    }
}

// Whether the scans so far hold the whole picture. Arithmetic codes may end early.
bool hasAllScans(const jpeg_decompress_struct& jpeg)
{
    if (jpeg.arith_code != FALSE || jpeg.progressive_mode == FALSE) {
        return jpeg.arith_code == FALSE && jpeg.comps_in_scan == jpeg.num_components;
    }
    for (int c = 0; c < jpeg.num_components; ++c) {
        if (std::any_of(jpeg.coef_bits[c], jpeg.coef_bits[c] + DCTSIZE2, [](int missing) { return missing != 0; })) {
            return false;
        }
    }
    return true;
}

// A few bytes can ask for scans without end.
void limitScans(j_common_ptr jpeg)
{
    constexpr int kMaxScans = 500;
    if (jpeg->is_decompressor != 0 && reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > kMaxScans) {
        auto& errors = *reinterpret_cast<JpegErrors*>(jpeg->err);
        std::snprintf(errors.message, sizeof errors.message, "it has more than %d scans", kMaxScans);
        std::longjmp(errors.leave, 1);
    }
}

struct JpegReader {
    jpeg_decompress_struct jpeg{};
    JpegErrors errors{};
    jpeg_progress_mgr progress{};

    JpegReader()
    {
        jpeg.err = jpeg_std_error(&errors.base);
        errors.base.error_exit = leaveJpeg;
        errors.base.emit_message = leaveOnDamage;
        progress.progress_monitor = limitScans;
        jpeg_create_decompress(&jpeg);
        jpeg.progress = &progress;
    }
    ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;
};

bool readJpegHeader(JpegReader& reader, Bytes bytes)
{
    if (setjmp(reader.errors.leave) != 0) {
        return false;
    }
    jpeg_mem_src(&reader.jpeg, bytes.data(), bytes.size());
    jpeg_read_header(&reader.jpeg, TRUE);
    return true;
}

// `row`: room for a row of four channels.
bool readJpegRows(JpegReader& reader, std::vector<std::uint8_t>& rgba, std::vector<std::uint8_t>& row)
{
    if (setjmp(reader.errors.leave) != 0) {
        return false;
    }
    jpeg_decompress_struct& jpeg = reader.jpeg;
    const bool inks = jpeg.num_components == 4;
    jpeg.out_color_space = inks ? JCS_CMYK : JCS_EXT_RGBA;
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
        std::uint8_t* const to = rgba.data() + std::size_t{jpeg.output_scanline} * jpeg.output_width * 4;
        JSAMPROW into = inks ? row.data() : to;
        jpeg_read_scanlines(&jpeg, &into, 1);
        for (std::size_t x = 0; inks && x < jpeg.output_width; ++x) {
            // Adobe's files hold the inks inverted.
            const auto ink = [&](std::size_t c) { return jpeg.saw_Adobe_marker != 0 ? row[4 * x + c] : 255 - row[4 * x + c]; };
            for (std::size_t c = 0; c < 3; ++c) {
                to[4 * x + c] = static_cast<std::uint8_t>((ink(c) * ink(3) + 127) / 255);
            }
            to[4 * x + 3] = 255;
        }
    }
    const bool whole = hasAllScans(jpeg);
    jpeg_finish_decompress(&jpeg);
    if (reader.errors.noEnd && !whole) {
        std::snprintf(reader.errors.message, sizeof reader.errors.message, "it ends early");
        return false;
    }
    return true;
}

DecodedImage decodeJpeg(Bytes bytes)
{
    JpegReader reader;
    const auto require = [&reader](bool good) {
        if (!good) {
            throw InputError(MessageId::FileDamaged, {"is a broken JPEG (", part::value(reader.errors.message), ")"});
        }
    };
    require(readJpegHeader(reader, bytes));
    checkImageSize("JPEG", reader.jpeg.image_width, reader.jpeg.image_height);
    // Huffman's codes have at least a bit for each block of 64 pixels: a header that promises more costs no memory.
    constexpr std::uint64_t kMaxPixelsPerByte = 512;
    if (reader.jpeg.arith_code == FALSE &&
        std::uint64_t{reader.jpeg.image_width} * reader.jpeg.image_height > kMaxPixelsPerByte * bytes.size()) {
        throw InputError(MessageId::FileDamaged, {"is a broken JPEG (", part::value("it ends early"), ")"});
    }
    DecodedImage image;
    image.width = reader.jpeg.image_width;
    image.height = reader.jpeg.image_height;
    image.rgba8.resize(std::size_t{image.width} * image.height * 4);
    std::vector<std::uint8_t> row(std::size_t{image.width} * 4);
    require(readJpegRows(reader, image.rgba8, row));
    image.noEnd = reader.errors.noEnd;
    return image;
}

DecodedImage decodeWebp(Bytes bytes)
{
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK) {
        throw InputError(MessageId::FileDamaged, {"is a ", part::value("broken WebP")});
    }
    if (features.has_animation != 0) {
        throw InputError(MessageId::Unsupported, {"is an ", part::value("animated WebP"), "; expected ", part::expected("a still one")});
    }
    DecodedImage image;
    image.width = static_cast<std::uint32_t>(features.width);
    image.height = static_cast<std::uint32_t>(features.height);
    checkImageSize("WebP", image.width, image.height);
    image.hasAlpha = features.has_alpha != 0;
    image.rgba8.resize(std::size_t{image.width} * image.height * 4);
    if (WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.rgba8.data(), image.rgba8.size(), features.width * 4) == nullptr) {
        throw InputError(MessageId::FileDamaged, {"is a ", part::value("broken WebP")});
    }
    return image;
}

bool isPng(Bytes bytes) { return startsWith(bytes, "\x89PNG\r\n\x1a\n"); }
bool isJpeg(Bytes bytes) { return startsWith(bytes, "\xff\xd8\xff"); }
bool isWebp(Bytes bytes) { return startsWith(bytes, "RIFF") && startsWith(bytes, "WEBP", 8); }
bool isAvif(Bytes bytes) { return startsWith(bytes, "ftypavi", 4); }  // one picture, or a sequence
bool isDds(Bytes bytes) { return startsWith(bytes, "DDS "); }

std::string firstBytes(Bytes bytes)
{
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(bytes.size(), 4); ++i) {
        char hex[4];
        std::snprintf(hex, sizeof hex, " %02x", bytes[i]);
        text += hex;
    }
    return text.empty() ? "it is empty" : "it begins with" + text;
}

}  // namespace

void checkImageSize(const char* kind, std::uint32_t width, std::uint32_t height)
{
    if (width == 0 || height == 0 || width > kMaxImageSide || height > kMaxImageSide) {
        throw InputError(MessageId::TooLarge,
                         {"is a ", kind, " of ", part::value(std::to_string(width) + "x" + std::to_string(height)), " pixels; expected ",
                          part::expected("1 to " + std::to_string(kMaxImageSide)), " in each direction"});
    }
}

bool beginsAsImage(Bytes bytes) { return isPng(bytes) || isJpeg(bytes) || isWebp(bytes) || isKtx2(bytes); }

DecodedImage decodeImage(Bytes bytes)
{
    if (isPng(bytes)) {
        return decodePng(bytes);
    }
    if (isJpeg(bytes)) {
        return decodeJpeg(bytes);
    }
    if (isWebp(bytes)) {
        return decodeWebp(bytes);
    }
    if (isKtx2(bytes)) {
        return decodeKtx2(bytes);
    }
    const std::string kind = isAvif(bytes) ? "AVIF" : isDds(bytes) ? "DDS" : "of an unknown kind (" + firstBytes(bytes) + ")";
    throw InputError(MessageId::UnknownFormat, {"is ", part::value(kind), "; expected ",
                                                part::expected("PNG, JPEG, WebP or KTX2, to which other programs convert it")});
}

}  // namespace glim
