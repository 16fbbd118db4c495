#include "host/image/picture_file.hpp"

#include "host/image/atomic_file.hpp"

#include <webp/encode.h>

#include <memory>
#include <new>

namespace glim {

void writeWebp(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgb8>& pixels)
{
    AtomicFile file(path);
    std::uint8_t* bytes = nullptr;
    const std::size_t size = WebPEncodeLosslessRGB(pixels.front().data(), static_cast<int>(width), static_cast<int>(height),
                                                   static_cast<int>(3 * width), &bytes);
    const std::unique_ptr<std::uint8_t, void (*)(void*)> owner(bytes, WebPFree);
    if (size == 0) {
        throw std::bad_alloc();  // libwebp gives no reason; every size that it refuses is too large
    }
    file.write(bytes, size);
    file.commit();
}

}  // namespace glim
