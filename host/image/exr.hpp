// OpenEXR files, read and written whole. Other formats and half-read files are refused with InputError.
#pragma once

#include "host/image/image.hpp"

#include <filesystem>

namespace glim {

// Scan lines or tiles (the finest level), any compression, the first part. The data window is the picture: its upper left
// pixel is (0, 0). Half and float channels come as floats, unsigned ones as counts; of the attributes, the numbers and strings
// that are not OpenEXR's own.
Image readExr(const std::filesystem::path& path);

// Size and attributes only.
Image readExrHeader(const std::filesystem::path& path);

// float32 and uint32 scan lines, ZIP, with the chromaticities of Rec.709. The same image gives the same bytes.
void writeExr(const std::filesystem::path& path, const Image& image);

}  // namespace glim
