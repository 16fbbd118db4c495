#include "host/image/picture_file.hpp"

#include "host/atomic_file.hpp"
#include "host/error.hpp"
#include "host/image/jpeg_errors.hpp"

#include <cstdlib>
#include <string>

namespace glim {
namespace {

constexpr int kQuality = 95;

struct JpegWriter {
    jpeg_compress_struct jpeg{};
    JpegErrors errors{};
    unsigned char* bytes = nullptr;
    unsigned long size = 0;

    JpegWriter()
    {
        jpeg.err = jpeg_std_error(&errors.base);
        errors.base.error_exit = leaveJpeg;
        jpeg_create_compress(&jpeg);
    }
    ~JpegWriter()
    {
        jpeg_destroy_compress(&jpeg);
        std::free(bytes);
    }
    JpegWriter(const JpegWriter&) = delete;
    JpegWriter& operator=(const JpegWriter&) = delete;
};

// False if libjpeg has given up.
bool encodeJpeg(JpegWriter& writer, std::uint32_t width, std::uint32_t height, const Rgb8* first)
{
    if (setjmp(writer.errors.leave) != 0) {
        return false;
    }
    jpeg_compress_struct& jpeg = writer.jpeg;
    jpeg_mem_dest(&jpeg, &writer.bytes, &writer.size);
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, kQuality, TRUE);
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;  // 2 would halve the resolution of the colours
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
        auto* row = const_cast<JSAMPROW>(first[std::size_t{jpeg.next_scanline} * width].data());
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    return true;
}

}  // namespace

void writeJpeg(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgb8>& pixels)
{
    AtomicFile file(path);
    JpegWriter writer;
    if (!encodeJpeg(writer, width, height, pixels.data())) {
        throw InputError(MessageId::FileUnwritable,
                         {part::file(path), ": cannot be written as JPEG (", part::value(writer.errors.message), ")."});
    }
    file.write(writer.bytes, writer.size);
    file.commit();
}

}  // namespace glim
