// Pictures for people to look at: 8 bits a channel, sRGB.
#pragma once

#include "host/image/png.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace glim {

enum class PictureKind { Png, Jpeg, Webp };

// The kind by the ending of the name: .png, .jpg or .jpeg, .webp, in upper or lower case. Nothing for other endings.
std::optional<PictureKind> getPictureKind(const std::filesystem::path& path);
// The endings, for sentences: ".png, .jpg, .jpeg or .webp".
inline constexpr const char* kPictureEndings = ".png, .jpg, .jpeg or .webp";

// The most pixels a side that files of this kind hold.
constexpr std::uint32_t longestSide(PictureKind kind)
{
    return kind == PictureKind::Jpeg ? 65500 : kind == PictureKind::Webp ? 16383 : 0x7fffffff;
}

constexpr bool hasAlpha(PictureKind kind) { return kind != PictureKind::Jpeg; }

// Writes sRGB bytes to a file of the kind that its name says. Throws InputError if it cannot be, and then nothing is written.
void writePicture(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgb8>& pixels);
// The same for kinds that have alpha.
void writePicture(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgba8>& pixels);

// As writePng. Quality 95, colours in full resolution (4:4:4).
void writeJpeg(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgb8>& pixels);

// As writePng, without loss.
void writeWebp(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgb8>& pixels);
void writeWebp(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgba8>& pixels);

}  // namespace glim
