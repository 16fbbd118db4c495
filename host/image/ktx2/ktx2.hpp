// KTX2 textures as KHR_texture_basisu has them: ETC1S under BasisLZ and UASTC, and plain bytes besides.
#pragma once

#include "host/image/decode_image.hpp"

#include <span>

namespace glim {

bool isKtx2(std::span<const unsigned char> bytes);

// The largest level. Throws InputError as decodeImage does. Whether colours are sRGB is not looked at: glTF says what a texture is for.
DecodedImage decodeKtx2(std::span<const unsigned char> bytes);

}  // namespace glim
