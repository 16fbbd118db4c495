#include "host/scene/gltf/gltf_container.hpp"

#include "host/error.hpp"
#include "host/input_file.hpp"
#include "host/scene/gltf/other_formats.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

namespace glim {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"
constexpr std::size_t kHeaderSize = 12, kChunkHeaderSize = 8;

// tinygltf recurses into extras and extensions; real files nest about ten levels.
constexpr int kMaxJsonDepth = 256;

std::uint32_t readU32(const std::vector<unsigned char>& bytes, std::size_t at)
{
    return std::uint32_t{bytes[at]} | std::uint32_t{bytes[at + 1]} << 8U | std::uint32_t{bytes[at + 2]} << 16U |
           std::uint32_t{bytes[at + 3]} << 24U;
}

// Reads a file piece by piece, so that a wrong beginning is found before gigabytes are read.
class PieceReader {
public:
    PieceReader(const std::filesystem::path& file, const std::string& expected)
        : path_(file.string())
    {
        requireFile(file, expected);
        stream_.open(file, std::ios::binary | std::ios::ate);
        const std::streamoff size = stream_ ? static_cast<std::streamoff>(stream_.tellg()) : -1;
        if (size < 0) {
            throw InputError(MessageId::FileUnreadable, {part::file(path_), ": cannot be read: ", std::strerror(errno)});
        }
        size_ = static_cast<std::uint64_t>(size);
        stream_.seekg(0);
    }

    std::uint64_t size() const { return size_; }
    void seek(std::uint64_t position) { stream_.seekg(static_cast<std::streamoff>(position)); }

    // A vector or a string.
    template <class Bytes>
    void fill(Bytes& bytes)
    {
        if (!stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) {
            throw InputError(MessageId::FileUnreadable, {part::file(path_), ": cannot be read to its end: ", std::strerror(errno)});
        }
    }
    // Text up to a byte 0, which no JSON has. Holes of a file read as such bytes, for gigabytes.
    std::string readText(std::uint64_t count)
    {
        constexpr std::uint64_t kPiece = std::uint64_t{1} << 20U;
        std::string text;
        for (std::size_t end = 0; text.size() < count && end == text.size();) {
            std::string piece(std::min(kPiece, count - text.size()), '\0');
            fill(piece);
            end = text.size() + piece.size();
            text.append(piece, 0, piece.find('\0'));
        }
        return text;
    }
    std::vector<unsigned char> read(std::uint64_t count)
    {
        std::vector<unsigned char> bytes(count);
        fill(bytes);
        return bytes;
    }

private:
    std::string path_;
    std::ifstream stream_;
    std::uint64_t size_ = 0;
};

// A .glb (glTF 2.0, section 4), whose first 12 bytes are `header`.
GltfContainer readChunks(const std::string& path, PieceReader& reader, const std::vector<unsigned char>& header)
{
    const std::uint32_t version = readU32(header, 4);
    const std::uint64_t length = readU32(header, 8);
    if (version != 2) {
        throw InputError(MessageId::UnknownFormat, {part::file(path), ": the binary container has version ",
                                                    part::value(std::to_string(version)), "; expected ", part::expected("2")});
    }
    if (length > reader.size()) {
        throw InputError(MessageId::FileDamaged,
                         {part::file(path), ": the file is truncated: it holds ", part::value(std::to_string(reader.size())),
                          " bytes; expected ", part::expected(std::to_string(length))});
    }
    GltfContainer container;
    std::uint64_t at = kHeaderSize;
    for (int chunk = 0; at < length; ++chunk) {
        const std::string place = "chunk " + std::to_string(chunk) + " of the binary container";
        reader.seek(at);
        const bool hasHeader = length - at >= kChunkHeaderSize;
        const std::vector<unsigned char> start = hasHeader ? reader.read(kChunkHeaderSize) : std::vector<unsigned char>();
        if (!hasHeader || length - at - kChunkHeaderSize < readU32(start, 0)) {
            throw InputError(MessageId::FileDamaged,
                             {part::file(path), ": ", part::place(place), " is truncated at byte ", part::value(std::to_string(length)),
                              "; expected ", part::expected("its whole content")});
        }
        const std::uint32_t size = readU32(start, 0), type = readU32(start, 4);
        if (chunk == 0 && type != kJsonChunk) {
            throw InputError(MessageId::FileDamaged, {part::file(path), ": ", part::place(place), " has type ",
                                                      part::value(std::to_string(type)), "; expected ", part::expected("JSON first")});
        }
        if (chunk == 0) {
            container.json = reader.readText(size);
        } else if (chunk == 1 && type == kBinChunk) {
            container.binary = {at + kChunkHeaderSize, size};
        }
        at += kChunkHeaderSize + size;
    }
    if (container.json.empty()) {
        throw InputError(MessageId::Missing,
                         {part::file(path), ": the binary container has no JSON chunk; expected ", part::expected("one")});
    }
    return container;
}

std::string_view withoutSpaces(std::string_view text)
{
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF", kSpaces = " \t\r\n";
    text.remove_prefix(text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
    text.remove_prefix(std::min(text.find_first_not_of(kSpaces), text.size()));
    return text;
}

bool mayBeJson(std::string_view start)
{
    const std::string_view text = withoutSpaces(start);
    return text.empty() || text.front() == '{' || text.front() == '[';
}

[[noreturn]] void refuseFormat(const std::filesystem::path& file, std::string_view start)
{
    const MessagePart path = part::file(file.string());
    if (const OtherFormat* const format = findOtherFormat(file, start)) {
        throw InputError(MessageId::UnknownFormat, {path, ": is ", part::value(std::string(format->name)), "; expected ",
                                                    part::expected("a .gltf or a .glb file, " + std::string(format->remedy))});
    }
    if (file.extension() == ".glb") {
        throw InputError(MessageId::UnknownFormat,
                         {path, ": does not start with the bytes ", part::expected("\"glTF\""), "; expected them in a .glb"});
    }
    const auto first = static_cast<unsigned char>(withoutSpaces(start).front());
    throw InputError(MessageId::UnknownFormat, {path, ": is not glTF: it begins with the byte ", part::value(std::to_string(first)),
                                                "; expected ", part::expected("a .gltf or a .glb file")});
}

int computeDepth(const std::string& text)
{
    int depth = 0, deepest = 0;
    bool inString = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (inString) {
            i += c == '\\' ? 1 : 0;
            inString = c != '"';
        } else if (c == '"') {
            inString = true;
        } else if (c == '{' || c == '[') {
            deepest = std::max(deepest, ++depth);
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return deepest;
}

}  // namespace

std::vector<unsigned char> readBytes(const std::filesystem::path& file, std::uint64_t most, std::uint64_t begin)
{
    PieceReader reader(file, "a file");
    begin = std::min(begin, reader.size());
    reader.seek(begin);
    return reader.read(std::min(reader.size() - begin, most));
}

GltfContainer openContainer(const std::filesystem::path& file)
{
    constexpr std::uint64_t kStart = 4096;
    const std::string path = file.string();
    PieceReader reader(file, "a .gltf or a .glb file");
    const std::vector<unsigned char> start = reader.read(std::min(reader.size(), kStart));
    if (start.empty()) {
        throw InputError(MessageId::Empty, {part::file(path), ": the file is empty; expected ", part::expected("glTF")});
    }
    if (start.size() >= 4 && readU32(start, 0) == kMagic) {
        if (start.size() < kHeaderSize) {
            throw InputError(MessageId::FileDamaged,
                             {part::file(path), ": the binary container is truncated at byte ", part::value(std::to_string(start.size())),
                              "; expected ", part::expected("a header of 12")});
        }
        return readChunks(path, reader, start);
    }
    const std::string_view text(reinterpret_cast<const char*>(start.data()), start.size());
    if (file.extension() == ".glb" || !mayBeJson(text)) {
        refuseFormat(file, text);
    }
    reader.seek(0);
    return {reader.readText(reader.size()), std::nullopt};
}

nlohmann::json parseJson(const std::string& path, const std::string& text)
{
    if (const int depth = computeDepth(text); depth > kMaxJsonDepth) {
        throw InputError(MessageId::TooLarge, {part::file(path), ": the JSON is nested ", part::value(std::to_string(depth)),
                                               " levels deep; expected ", part::expected("at most " + std::to_string(kMaxJsonDepth))});
    }
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        throw InputError(MessageId::Malformed,
                         {part::file(path), ": not JSON: syntax error at byte ", part::value(std::to_string(error.byte))});
    } catch (const nlohmann::json::exception&) {
        throw InputError(MessageId::OutOfRange, {part::file(path), ": the JSON holds a number that does not fit a double; expected ",
                                                 part::expected("finite numbers")});
    }
}

}  // namespace glim
