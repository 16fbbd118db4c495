#include "host/image/png.hpp"

#include "host/atomic_file.hpp"
#include "host/error.hpp"
#include "host/image/srgb.hpp"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <string>

namespace glim {
namespace {

struct PngSink {
    AtomicFile& file;
    const std::string name;
    std::optional<Message> error = {};
};

// libpng is written in C and ends by longjmp, which no exception may cross. So the reason of a failure is kept until libpng returns.
void pngWrite(png_structp png, png_bytep bytes, png_size_t count)
{
    auto* sink = static_cast<PngSink*>(png_get_io_ptr(png));
    try {
        sink->file.write(bytes, count);
        return;
    } catch (const InputError& error) {
        sink->error = error.message();
    }
    png_error(png, "write");
}

void pngFlush(png_structp) {}

[[noreturn]] void pngFail(png_structp png, png_const_charp reason)
{
    auto* sink = static_cast<PngSink*>(png_get_error_ptr(png));
    if (!sink->error) {
        sink->error.emplace(
            MessageId::FileUnwritable,
            std::initializer_list<MessagePart>{part::file(sink->name), ": cannot be written as PNG (", part::value(reason), ")."});
    }
    png_longjmp(png, 1);
}

void pngWarn(png_structp, png_const_charp) {}

struct Rows {
    std::uint32_t width, height;
    std::size_t channels;
    const std::uint8_t* first;
};

void writeRows(png_structp png, png_infop info, const Rows& rows)
{
    png_set_IHDR(png, info, rows.width, rows.height, 8, rows.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    for (std::size_t y = 0; y < rows.height; ++y) {
        png_write_row(png, rows.first + y * rows.width * rows.channels);
    }
    png_write_end(png, info);
}

// Has no local object with a destructor, since setjmp may return a second time.
bool encodePng(PngSink& sink, const Rows& rows)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, pngFail, pngWarn);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr) {
        png_destroy_write_struct(&png, nullptr);
        throw std::bad_alloc();
    }
    if (setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_user_limits(png, rows.width, rows.height);
    png_set_write_fn(png, &sink, pngWrite, pngFlush);
    writeRows(png, info, rows);
    png_destroy_write_struct(&png, &info);
    return true;
}

void writeRows(const std::filesystem::path& path, const Rows& rows)
{
    AtomicFile file(path);
    PngSink sink{file, path.string()};
    if (!encodePng(sink, rows)) {
        throw InputError(*sink.error);
    }
    file.commit();
}

}  // namespace

std::uint8_t srgbByte(double linear)
{
    const double x = std::clamp(linear, 0.0, 1.0);
    const double encoded = srgbFromLinear(x);
    return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

Rgb8 roundToBytes(const glm::dvec3& color)
{
    const auto round = [](double channel) { return static_cast<std::uint8_t>(std::lround(channel)); };
    return {round(color.r), round(color.g), round(color.b)};
}

void writePng(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgb8>& pixels)
{
    writeRows(path, {width, height, 3, pixels.front().data()});
}

void writePng(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgba8>& pixels)
{
    writeRows(path, {width, height, 4, pixels.front().data()});
}

}  // namespace glim
