// Mutants of KTX2: one part is mutated, and the container around it fits again. What Zstandard compresses is mutated plain.
#include "tests/fuzz/mutator.hpp"

#include <zstd.h>

#include <array>
#include <cstring>
#include <string>

namespace glim::fuzz {
namespace {

// Where the header says where parts are: a whole number of `width` bytes each for offset and length.
struct Place {
    std::size_t at, width;
};
constexpr std::size_t kLevelAt = 80, kFirstByte = 104;
constexpr std::array<Place, 4> kPlaces{{{48, 4}, {56, 4}, {64, 8}, {kLevelAt, 8}}};  // descriptor, keys, global data, level 0
constexpr std::size_t kGlobal = 2, kLevel = 3, kSchemeAt = 44;
constexpr std::size_t kMaxPlain = 1 << 16;

std::uint64_t readNumber(const std::string& bytes, std::size_t at, std::size_t width)
{
    std::uint64_t number = 0;
    if (at + width <= bytes.size()) {
        std::memcpy(&number, bytes.data() + at, width);
    }
    return number;
}

void writeNumber(std::string& bytes, std::size_t at, std::size_t width, std::uint64_t number)
{
    if (at + width <= bytes.size()) {
        std::memcpy(bytes.data() + at, &number, width);
    }
}

std::string cut(const std::string& bytes, const Place& place)
{
    const std::uint64_t offset = readNumber(bytes, place.at, place.width), length = readNumber(bytes, place.at + place.width, place.width);
    return offset < bytes.size() ? bytes.substr(offset, length) : "";
}

std::string inflate(const std::string& compressed)
{
    std::string plain(kMaxPlain, '\0');
    const std::size_t size = ZSTD_decompress(plain.data(), plain.size(), compressed.data(), compressed.size());
    plain.resize(ZSTD_isError(size) != 0 ? 0 : size);
    return plain;
}

std::string deflate(const std::string& plain)
{
    std::string compressed(ZSTD_compressBound(plain.size()), '\0');
    compressed.resize(ZSTD_compress(compressed.data(), compressed.size(), plain.data(), plain.size(), 1));
    return compressed;
}

// The lengths of the codebooks and tables, and of the first image's slice, where their bytes have grown or shrunk.
void fitGlobal(std::string& global, std::size_t before, Choice& choice)
{
    constexpr std::size_t kLengthsAt = 4;
    const std::size_t at = kLengthsAt + 4 * choice.below(3);
    writeNumber(global, at, 4, readNumber(global, at, 4) + global.size() - before);
}

void mutateKtx2(std::string& bytes, Choice& choice)
{
    std::array<std::string, kPlaces.size()> parts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        parts[i] = cut(bytes, kPlaces[i]);
    }
    std::string header = bytes.substr(0, kFirstByte);
    const bool zstandard = readNumber(header, kSchemeAt, 4) == 2;
    std::string plain = zstandard ? inflate(parts[kLevel]) : "";
    const std::size_t chosen = choice.oneIn(4) ? choice.below(parts.size() + 1) : choice.oneIn(2) ? kGlobal : kLevel;
    const std::size_t growth = choice.oneIn(2) ? 0 : 16;
    if (chosen == parts.size()) {
        mutateBytes(header, 0);
        header.resize(kFirstByte);
    } else if (chosen == kLevel && !plain.empty() && !choice.oneIn(4)) {
        mutateBytes(plain, 0);
        parts[kLevel] = deflate(plain);
        writeNumber(header, kLevelAt + 16, 8, plain.size());
    } else {
        const std::size_t before = parts[chosen].size();
        mutateBytes(parts[chosen], growth);
        if (chosen == kGlobal && !choice.oneIn(4)) {
            fitGlobal(parts[kGlobal], before, choice);
        }
    }
    bytes = header;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        writeNumber(bytes, kPlaces[i].at, kPlaces[i].width, bytes.size());
        writeNumber(bytes, kPlaces[i].at + kPlaces[i].width, kPlaces[i].width, parts[i].size());
        bytes += parts[i];
    }
}

}  // namespace
}  // namespace glim::fuzz

using namespace glim::fuzz;

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed)
{
    Choice choice(seed);
    std::string bytes(reinterpret_cast<const char*>(data), size);
    if (size < kFirstByte || choice.oneIn(8)) {
        mutateBytes(bytes, 64);
    } else {
        mutateKtx2(bytes, choice);
    }
    return handOver(bytes, data, size, room);
}
