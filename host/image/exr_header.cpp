#include "host/image/exr_header.hpp"

#include "host/digest.hpp"
#include "host/error.hpp"

#include <OpenEXR/ImfHeader.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

namespace fs = std::filesystem;

namespace glim {
namespace {

// OpenEXR allocates by a header's height before anything can be checked.
constexpr int kMaxExrSide = 1 << 18;

// OpenEXR reads as many bytes of these, whatever the attribute's size says, and takes what follows for the next attribute.
struct FixedType {
    const char* name;
    std::size_t bytes;
};
constexpr FixedType kFixedTypes[] = {
    {"box2i", 16},
    {"box2f", 16},
    {"chromaticities", 32},
    {"compression", 1},
    {"deepImageState", 1},
    {"double", 8},
    {"envmap", 1},
    {"float", 4},
    {"int", 4},
    {"keycode", 28},
    {"lineOrder", 1},
    {"m33f", 36},
    {"m33d", 72},
    {"m44f", 64},
    {"m44d", 128},
    {"v2i", 8},
    {"v2f", 8},
    {"v2d", 16},
    {"v3i", 12},
    {"v3f", 12},
    {"v3d", 24},
    {"rational", 8},
    {"tiledesc", 9},
    {"timecode", 8},
};

// Four bytes, the least first; 0 past the end.
std::uint32_t u32(const std::string& bytes, std::size_t at)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i) {
        value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << 8U * i;
    }
    return value;
}

std::uint32_t readU32(std::istream& stream)
{
    std::string bytes(4, '\0');
    stream.read(bytes.data(), std::ssize(bytes));
    return u32(bytes, 0);
}

// A name and 16 bytes for each channel, then an empty name.
bool areChannels(const std::string& value)
{
    constexpr std::size_t kChannel = 16;
    for (std::size_t at = 0; at < value.size();) {
        const std::size_t end = value.find('\0', at);
        if (end == at || end == std::string::npos) {
            return end == at && end + 1 == value.size();
        }
        at = end + 1 + kChannel;
    }
    return false;
}

// The length of each text before it.
bool areTexts(const std::string& value)
{
    std::size_t at = 0;
    while (at + 4 <= value.size()) {
        at += std::size_t{4} + u32(value, at);
    }
    return at == value.size();
}

bool fits(const std::string& type, const std::string& value)
{
    constexpr std::uint64_t kMaxDeflated = 1032;
    if (type == "chlist") {
        return areChannels(value);
    }
    if (type == "stringvector") {
        return areTexts(value);
    }
    if (type == "preview") {
        return value.size() >= 8 && value.size() - 8 == std::uint64_t{4} * u32(value, 0) * u32(value, 4);
    }
    if (type == "idmanifest") {
        return value.size() >= 4 && u32(value, 0) <= kMaxDeflated * value.size();
    }
    const auto* fixed = std::find_if(std::begin(kFixedTypes), std::end(kFixedTypes), [&](const FixedType& t) { return t.name == type; });
    return fixed == std::end(kFixedTypes) || fixed->bytes == value.size();
}

}  // namespace

// Magic number, version, then attributes: name, type, size and value. An empty name ends the header; files of several parts have more.
void checkExrHeader(const fs::path& path)
{
    Imf::Header::setMaxImageSize(kMaxExrSide, kMaxExrSide);
    constexpr std::uint32_t kSeveralParts = 0x1000;
    std::ifstream stream(path, std::ios::binary | std::ios::ate);
    const std::streamoff size = stream.tellg();
    stream.seekg(0);
    readU32(stream);
    const bool more = (readU32(stream) & kSeveralParts) != 0;
    std::string name, type, value;
    while (std::getline(stream, name, '\0')) {
        if (name.empty()) {
            if (!more || stream.peek() == 0) {
                return;
            }
            continue;
        }
        std::getline(stream, type, '\0');
        const std::streamoff bytes = readU32(stream), left = stream ? size - stream.tellg() : 0;
        const MessagePart attribute(MessagePart::Kind::Place, inQuotes(name), name);
        if (bytes > left) {
            throw InputError(MessageId::FileDamaged,
                             {part::file(path), ": is damaged: its attribute ", attribute, " has ", part::value(std::to_string(bytes)),
                              " bytes, expected ", part::expected("at most the " + std::to_string(left) + " that follow"), "."});
        }
        value.resize(static_cast<std::size_t>(bytes));
        stream.read(value.data(), bytes);
        if (!fits(type, value)) {
            throw InputError(MessageId::FileDamaged, {part::file(path), ": is damaged: its attribute ", attribute, " has ",
                                                      part::value(std::to_string(bytes)), " bytes, which make no ", inQuotes(type), "."});
        }
    }
}

std::optional<HeaderSeal> findSeal(std::istream& stream, const std::string& attribute)
{
    constexpr std::streamoff kBegin = 8;  // after the magic number and the version
    std::optional<HeaderSeal> seal;
    stream.seekg(kBegin);
    std::string name, type;
    while (std::getline(stream, name, '\0') && !name.empty() && std::getline(stream, type, '\0')) {
        const std::streamoff bytes = readU32(stream);
        if (name == attribute) {
            seal = {static_cast<std::uint64_t>(stream.tellg()), std::string(static_cast<std::size_t>(bytes), '\0'), {}};
            stream.read(seal->text.data(), bytes);
        } else {
            stream.seekg(bytes, std::ios::cur);
        }
    }
    const std::streamoff end = stream.tellg();
    if (!seal || end < 0) {
        return std::nullopt;
    }
    std::string header(static_cast<std::size_t>(end), '\0');
    stream.seekg(0);
    stream.read(header.data(), end);
    std::fill_n(header.begin() + static_cast<std::ptrdiff_t>(seal->position), seal->text.size(), '\0');
    Digest digest;
    digest.add(std::as_bytes(std::span(header)));
    seal->digest = digest.finish();
    return seal;
}

}  // namespace glim
