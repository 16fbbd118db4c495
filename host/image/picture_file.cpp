#include "host/image/picture_file.hpp"

#include "host/error.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <cassert>
#include <map>
#include <string>

namespace glim {
namespace {

// The kind of a file that can hold the picture. Throws InputError if there is none.
PictureKind kindFor(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height)
{
    const std::optional<PictureKind> kind = getPictureKind(path);
    if (!kind) {
        throw InputError(MessageId::UnknownFormat,
                         {part::file(path), ": cannot be written: its name does not end in ", part::expected(kPictureEndings), "."});
    }
    if (std::max(width, height) > longestSide(*kind)) {
        throw InputError(
            MessageId::TooLarge,
            {part::file(path), ": cannot be written: a picture of ", part::value(std::to_string(width) + "x" + std::to_string(height)),
             " pixels; expected ", part::expected("at most " + std::to_string(longestSide(*kind))), " a side in a file of this kind."});
    }
    return *kind;
}

}  // namespace

std::optional<PictureKind> getPictureKind(const std::filesystem::path& path)
{
    static const std::map<std::string, PictureKind> kKinds{
        {".png", PictureKind::Png}, {".jpg", PictureKind::Jpeg}, {".jpeg", PictureKind::Jpeg}, {".webp", PictureKind::Webp}};
    const auto found = kKinds.find(lowerCase(path.extension().string()));
    return found == kKinds.end() ? std::nullopt : std::optional(found->second);
}

void writePicture(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgb8>& pixels)
{
    switch (kindFor(path, width, height)) {
    case PictureKind::Png: return writePng(path, width, height, pixels);
    case PictureKind::Jpeg: return writeJpeg(path, width, height, pixels);
    case PictureKind::Webp: return writeWebp(path, width, height, pixels);
    }
}

void writePicture(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgba8>& pixels)
{
    const PictureKind kind = kindFor(path, width, height);
    assert(hasAlpha(kind));
    kind == PictureKind::Png ? writePng(path, width, height, pixels) : writeWebp(path, width, height, pixels);
}

}  // namespace glim
