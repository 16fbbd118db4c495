#include "host/image/picture_file.hpp"

#include "host/atomic_file.hpp"

#include <webp/encode.h>

#include <new>

namespace glim {
namespace {

struct FreedPicture {
    WebPPicture picture{};
    ~FreedPicture() { WebPPictureFree(&picture); }
};

struct ClearedWriter {
    WebPMemoryWriter writer{};
    ~ClearedWriter() { WebPMemoryWriterClear(&writer); }
};

// `import` is WebPPictureImportRGB or WebPPictureImportRGBA.
template <class Pixel>
void write(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Pixel>& pixels,
           decltype(WebPPictureImportRGB)* import)
{
    AtomicFile file(path);
    WebPConfig config;
    FreedPicture freed;
    ClearedWriter cleared;
    WebPPicture& picture = freed.picture;
    WebPMemoryWriterInit(&cleared.writer);
    bool done = WebPConfigInit(&config) != 0 && WebPPictureInit(&picture) != 0;
    config.lossless = 1;
    config.exact = 1;        // transparent pixels keep their colour
    config.quality = 70.0F;  // effort; what WebPEncodeLosslessRGB takes
    picture.use_argb = 1;
    picture.width = static_cast<int>(width);
    picture.height = static_cast<int>(height);
    picture.writer = WebPMemoryWrite;
    picture.custom_ptr = &cleared.writer;
    done = done && import(&picture, pixels.front().data(), static_cast<int>(sizeof(Pixel) * width)) != 0;
    if (!done || WebPEncode(&config, &picture) == 0) {
        throw std::bad_alloc();  // every size that libwebp refuses is too large
    }
    file.write(cleared.writer.mem, cleared.writer.size);
    file.commit();
}

}  // namespace

void writeWebp(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgb8>& pixels)
{
    write(path, width, height, pixels, WebPPictureImportRGB);
}

void writeWebp(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgba8>& pixels)
{
    write(path, width, height, pixels, WebPPictureImportRGBA);
}

}  // namespace glim
