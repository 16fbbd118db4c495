// A glTF file with checked JSON and its buffers in memory. All readers in this folder begin with it.
#pragma once

#include "host/scene/keyframes.hpp"
#include "host/scene/scene.hpp"
#include "host/scene/warnings.hpp"

#include <tiny_gltf.h>
#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glim {

using Buffers = std::vector<std::vector<unsigned char>>;

struct BufferRange {
    std::size_t buffer = 0;
    std::uint64_t offset = 0, length = 0;
};

// An encoded image: in a file of its own, or in a range of one of the buffers.
struct EncodedImage {
    std::string name;
    std::string uri;                   // relative to the glTF file, or data:
    std::optional<BufferRange> range;  // where there is no uri
};

// A texture with its sampler.
struct GltfTexture {
    std::string name;
    std::optional<std::size_t> image;  // the one that glim reads, of those that the texture offers
    Wrap wrapS = Wrap::Repeat, wrapT = Wrap::Repeat;
    bool nearest = false;
};

struct GltfSkin {
    std::string name;
    std::vector<std::size_t> joints;  // nodes
    std::optional<std::size_t> inverseBindMatrices;
};

struct GltfAnimation {
    struct Sampler {
        std::size_t input = 0, output = 0;
        Interpolation interpolation = Interpolation::Linear;
    };
    struct Channel {
        std::size_t sampler = 0;
        std::string pointer;  // to a property, as KHR_animation_pointer has it; empty: to nothing
    };
    std::string name;
    std::vector<Sampler> samplers;
    std::vector<Channel> channels;
};

struct GltfFile {
    std::string path;                          // as given, for messages
    std::vector<std::filesystem::path> files;  // this one and those of its buffers
    // Index properties are in range, numbers have their type, nothing is compressed. Holds none of what is listed below.
    tinygltf::Model model;
    std::shared_ptr<const nlohmann::json> document;  // of an animated file: what the model was parsed from
    std::shared_ptr<const nlohmann::json> original;  // of a file with edits: its checked JSON, without them, and with what is compressed
    Buffers buffers;                                 // the file's, each at least as long as its byteLength, then what was decompressed
    std::size_t ownBuffers = 0;                      // how many are the file's
    std::uint64_t ownBytes = 0;                      // in them and in the JSON
    std::vector<EncodedImage> images;
    std::vector<EncodedImage> ownImages;  // of a file with edits: without them
    std::vector<GltfTexture> textures;
    std::vector<GltfSkin> skins;
    std::vector<GltfAnimation> animations;
    bool confined = false;               // refuses files outside of its folder
    std::optional<std::size_t> variant;  // of KHR_materials_variants, that is to be drawn
    Warnings warnings;                   // of what was mended in its JSON
    Warnings editWarnings;               // and in edits
};

// `confined`: refuses files that the document or an edit names outside of its folder.
GltfFile readGltfFile(const std::filesystem::path& file, bool confined);

// The bytes of a uri: data in it, or at most the first `most` of a file relative to the glTF file. `place` names what has the uri.
std::vector<unsigned char> readUri(const std::string& path, const std::string& place, const std::string& uri,
                                   std::uint64_t most = std::numeric_limits<std::uint64_t>::max());
bool isDataUri(const std::string& uri);
// Which image is read of those that a texture of the document offers.
std::optional<std::size_t> imageOf(const nlohmann::json& texture);
// Where a uri that is not data: points: to the first file that is there of its name as it is, decoded, and with slashes for backslashes, as
// exporters write all three.
std::filesystem::path externalFile(const std::string& path, const std::string& uri);
// Refuses a uri that points out of the folder of the glTF file, links followed.
void refuseOutside(const std::string& path, const std::string& place, const std::string& uri);

// What an object with `buffer`, `byteOffset` and `byteLength` names.
BufferRange getRange(const nlohmann::json& view);
// Refuses a range that ends past its buffer. `place` names what has the range.
std::span<const unsigned char> findBytes(const std::string& path, const Buffers& buffers, const BufferRange& range,
                                         const std::string& place);

// Throws InputError: "<path>: <words>".
[[noreturn]] void refuse(const std::string& path, MessageId id, std::initializer_list<MessagePart> words);
[[noreturn]] void refuse(const GltfFile& file, MessageId id, std::initializer_list<MessagePart> words);

// How messages name things: nodes[3] ("lamp").
std::string label(const char* collection, std::size_t index, const std::string& name);
std::string nodeLabel(const GltfFile& file, std::size_t node);

std::string toText(double value);  // at most six significant digits

}  // namespace glim
