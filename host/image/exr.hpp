// OpenEXR files, read and written whole. Files of other formats and damaged files are refused with InputError.
#pragma once

#include "host/image/image.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace glim {

// Reads the first part of a file of scan lines or tiles (the finest level) with any compression. The upper left pixel of the data
// window becomes (0, 0). Half and float channels become float channels, unsigned ones counts. Attributes are kept if they are numbers,
// strings or glim's bytes and not OpenEXR's own.
Image readExr(const std::filesystem::path& path);

// Reads only the size and the attributes.
Image readExrHeader(const std::filesystem::path& path);

// A text attribute that seals the header: writing a picture that has it, whatever its value, makes it the SHA-256 of the header's bytes
// (HeaderSeal).
inline const std::string kHeaderDigest = "glim:headerDigest";

// Refuses a file whose header is not as it was sealed, and one that is not sealed if it has to be. To be called after reading.
void checkHeaderDigest(const std::filesystem::path& path, bool isSealed);

// Writes float32 and uint32 scan lines with ZIP compression and the chromaticities of Rec.709. Equal images give equal bytes.
void writeExr(const std::filesystem::path& path, const Image& image);

// Does the same in bands of rows, for pictures that are not in memory as a whole. Without `commit` nothing remains.
class ExrWriter {
public:
    // `picture` has the size, the attributes and the names of the channels. Their values are not read.
    ExrWriter(const std::filesystem::path& path, const Image& picture);
    ~ExrWriter();

    // The next rows, from the top; all channels.
    void write(const Image& rows);
    void commit();

private:
    struct Output;
    std::unique_ptr<Output> output_;
};

}  // namespace glim
