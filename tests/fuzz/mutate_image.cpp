// Mutants of images: PNG chunks get their checksums back, OpenEXR has a mutator of its own (mutate_exr.hpp).
#include "tests/fuzz/mutate_exr.hpp"

#include <zlib.h>

#include <algorithm>
#include <string>

namespace glim::fuzz {
namespace {

std::uint32_t bigEndian(const std::string& bytes, std::size_t at)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
    }
    return value;
}

// Of each chunk: length, type, data, checksum of type and data.
void repairChecksums(std::string& png)
{
    for (std::size_t at = 8; at + 12 <= png.size();) {
        const std::size_t length = bigEndian(png, at);
        if (length > png.size() - at - 12) {
            return;
        }
        const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(&png[at + 4]), static_cast<uInt>(length + 4));
        for (std::size_t i = 0; i < 4; ++i) {
            png[at + 8 + length + i] = static_cast<char>(checksum >> (24 - 8 * i) & 255U);
        }
        at += 12 + length;
    }
}

}  // namespace
}  // namespace glim::fuzz

using namespace glim::fuzz;

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed)
{
    Choice choice(seed);
    std::string bytes(reinterpret_cast<const char*>(data), size);
    if (bytes.rfind("\x76\x2f\x31\x01", 0) == 0) {
        mutateExr(bytes, choice);
    } else {
        mutateBytes(bytes, 64);
    }
    if (bytes.rfind("\x89PNG", 0) == 0 && !choice.oneIn(8)) {
        repairChecksums(bytes);
    }
    return handOver(bytes, data, size, room);
}
