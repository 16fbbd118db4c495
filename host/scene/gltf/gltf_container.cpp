#include "host/scene/gltf/gltf_container.hpp"

#include "host/error.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

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

GltfContainer splitChunks(const std::string& path, const std::vector<unsigned char>& bytes, std::size_t length)
{
    GltfContainer container;
    std::size_t at = kHeaderSize;
    for (int chunk = 0; at < length; ++chunk) {
        const std::string place = path + ": chunk " + std::to_string(chunk) + " of the binary container";
        if (length - at < kChunkHeaderSize || length - at - kChunkHeaderSize < readU32(bytes, at)) {
            throw InputError(place + " is truncated at byte " + std::to_string(length) + "; expected its whole content");
        }
        const std::uint32_t size = readU32(bytes, at), type = readU32(bytes, at + 4);
        const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at + kChunkHeaderSize);
        if (chunk == 0 && type != kJsonChunk) {
            throw InputError(place + " has type " + std::to_string(type) + "; expected JSON first");
        }
        if (chunk == 0) {
            container.json.assign(begin, begin + size);
        } else if (chunk == 1 && type == kBinChunk) {
            container.binary.emplace(begin, begin + size);
        }
        at += kChunkHeaderSize + size;
    }
    if (container.json.empty()) {
        throw InputError(path + ": the binary container has no JSON chunk; expected one");
    }
    return container;
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

std::vector<unsigned char> readBytes(const std::filesystem::path& file)
{
    if (file.empty()) {
        throw InputError("The scene's file name is empty");
    }
    std::error_code ignored;
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    const std::streamoff size = stream ? static_cast<std::streamoff>(stream.tellg()) : -1;
    if (std::filesystem::is_directory(file, ignored)) {
        throw InputError(file.string() + ": is a directory; expected a file");
    }
    if (size < 0) {
        throw InputError(file.string() + ": cannot be read: " + std::strerror(errno));
    }
    std::vector<unsigned char> bytes(static_cast<std::size_t>(size));
    stream.seekg(0);
    stream.read(reinterpret_cast<char*>(bytes.data()), size);
    if (!stream) {
        throw InputError(file.string() + ": cannot be read to its end: " + std::strerror(errno));
    }
    return bytes;
}

GltfContainer openContainer(const std::string& path, std::vector<unsigned char> bytes)
{
    if (bytes.empty()) {
        throw InputError(path + ": the file is empty; expected glTF");
    }
    if (bytes.size() < 4 || readU32(bytes, 0) != kMagic) {
        if (std::filesystem::path(path).extension() == ".glb") {
            throw InputError(path + ": does not start with the bytes \"glTF\"; expected them in a .glb");
        }
        return {std::string(bytes.begin(), bytes.end()), std::nullopt};
    }
    if (bytes.size() < kHeaderSize) {
        throw InputError(path + ": the binary container is truncated at byte " + std::to_string(bytes.size()) +
                         "; expected a header of 12");
    }
    const std::uint32_t version = readU32(bytes, 4), length = readU32(bytes, 8);
    if (version != 2) {
        throw InputError(path + ": the binary container has version " + std::to_string(version) + "; expected 2");
    }
    if (length > bytes.size()) {
        throw InputError(path + ": the file is truncated: it holds " + std::to_string(bytes.size()) + " bytes; expected " +
                         std::to_string(length));
    }
    return splitChunks(path, bytes, length);
}

nlohmann::json parseJson(const std::string& path, const std::string& text)
{
    if (const int depth = computeDepth(text); depth > kMaxJsonDepth) {
        throw InputError(path + ": the JSON is nested " + std::to_string(depth) + " levels deep; expected at most " +
                         std::to_string(kMaxJsonDepth));
    }
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        throw InputError(path + ": not JSON: syntax error at byte " + std::to_string(error.byte));
    } catch (const nlohmann::json::exception&) {
        throw InputError(path + ": the JSON holds a number that does not fit a double; expected finite numbers");
    }
}

}  // namespace glim
