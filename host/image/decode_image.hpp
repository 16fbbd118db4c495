// PNG, JPEG, WebP and KTX2 to texels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace glim {

inline constexpr std::uint32_t kMaxImageSide = 16384;

// RGBA, rows from the top, as the file holds it: nothing is converted to linear. One of the two vectors is filled.
struct DecodedImage {
    std::uint32_t width = 0, height = 0;
    bool hasAlpha = false;  // the file has such a channel or a transparent colour; else alpha is 1
    bool noEnd = false;     // a JPEG whose end marker is missing, and nothing else
    std::vector<std::uint8_t> rgba8;
    std::vector<std::uint16_t> rgba16;
};

// Throws InputError unless both sides are from 1 to kMaxImageSide. `kind`: as in "PNG".
void checkImageSize(const char* kind, std::uint32_t width, std::uint32_t height);

// Whether these are the first bytes of a kind that decodeImage knows; it looks at twelve.
bool beginsAsImage(std::span<const unsigned char> bytes);

// Tells the kind by the bytes. Throws InputError with what is wrong, as in "is a JPEG that ends early"; the caller names the image.
DecodedImage decodeImage(std::span<const unsigned char> bytes);

}  // namespace glim
