#include "host/error.hpp"
#include "host/scene/gltf/decode_attributes.hpp"
#include "host/scene/gltf/decompress.hpp"
#include "host/scene/gltf/gltf_schema.hpp"

#include <nlohmann/json.hpp>

#include <meshoptimizer.h>

namespace glim {
namespace {

using nlohmann::json;

// More bytes than this for each compressed one are refused before memory is asked for them. The bitstreams cannot reach more than 64 (the
// first one) or 1024 (the second, where two bits can stand for 256 bytes).
constexpr std::uint64_t kMaxCompression = 1024;

// What the views of a file may hold together. So many bytes are never too many; beyond, a file of zeros in version 0 of attributes has 64
// for each of its own. Version 1 could make a gigabyte of a megabyte, but only of elements that are all the same.
constexpr std::uint64_t kFewBytes = std::uint64_t{1} << 26U, kDecodedPerByte = 64;

class ViewDecoder {
public:
    // `source` is the extension of a buffer view, `place` its name in messages.
    ViewDecoder(const std::string& path, const std::string& place, const json& source)
        : path_(path),
          place_(place),
          mode_(source.at("mode").get<std::string>()),
          filter_(source.value("filter", "NONE")),
          count_(source.at("count").get<std::uint64_t>()),
          stride_(source.at("byteStride").get<std::uint64_t>())
    {
        check();
    }

    void checkSize(std::uint64_t viewLength, std::uint64_t compressed) const
    {
        require(viewLength / stride_ == count_ && viewLength % stride_ == 0, MessageId::Mismatch,
                {part::place(place_), " has ", part::value(std::to_string(count_)), " elements of ", std::to_string(stride_),
                 " bytes; expected ", part::expected("as many bytes as the " + std::to_string(viewLength) + " of its bufferView")});
        require(viewLength / kMaxCompression <= compressed, MessageId::TooLarge,
                {part::place(place_), " claims ", part::value(std::to_string(viewLength)), " bytes; expected ",
                 part::expected("at most " + std::to_string(kMaxCompression * compressed) + " of its " + std::to_string(compressed))});
    }

    std::vector<unsigned char> decode(std::span<const unsigned char> bytes) const
    {
        std::vector<unsigned char> decoded(count_ * stride_);
        require(decode(bytes, decoded), MessageId::FileDamaged,
                {part::place(place_), " holds ", part::value(std::to_string(bytes.size())),
                 " bytes that are damaged or of an unknown version; expected ",
                 part::expected(std::to_string(count_) + " elements in mode " + mode_)});
        if (filter_ == "OCTAHEDRAL") {
            meshopt_decodeFilterOct(decoded.data(), count_, stride_);
        } else if (filter_ == "QUATERNION") {
            meshopt_decodeFilterQuat(decoded.data(), count_, stride_);
        } else if (filter_ == "EXPONENTIAL") {
            meshopt_decodeFilterExp(decoded.data(), count_, stride_);
        } else if (filter_ == "COLOR") {
            decodeColors(stride_, decoded);
        }
        return decoded;
    }

private:
    void require(bool right, MessageId id, std::initializer_list<MessagePart> words) const
    {
        if (!right) {
            refuse(path_, id, words);
        }
    }

    // The library of Debian 12 and 13 knows version 0 of attributes only.
    bool decode(std::span<const unsigned char> bytes, std::vector<unsigned char>& decoded) const
    {
        if (mode_ == "ATTRIBUTES") {
            return decodeAttributes(bytes, stride_, decoded);
        }
        const int error = mode_ == "TRIANGLES" ? meshopt_decodeIndexBuffer(decoded.data(), count_, stride_, bytes.data(), bytes.size())
                                               : meshopt_decodeIndexSequence(decoded.data(), count_, stride_, bytes.data(), bytes.size());
        return error == 0;
    }

    // What the decoders take for granted.
    void check() const
    {
        const auto requireStride = [this](bool right, const std::string& expected) {
            require(right, MessageId::OutOfRange,
                    {part::place(place_ + ".byteStride"), " is ", part::value(std::to_string(stride_)), "; expected ",
                     part::expected(expected)});
        };
        if (mode_ == "ATTRIBUTES") {
            requireStride(stride_ % 4 == 0, "a multiple of 4 in mode ATTRIBUTES");
            requireStride((filter_ != "OCTAHEDRAL" && filter_ != "COLOR") || stride_ == 4 || stride_ == 8,
                          "4 or 8 for the filter " + filter_);
            requireStride(filter_ != "QUATERNION" || stride_ == 8, "8 for the filter QUATERNION");
            return;
        }
        requireStride(stride_ == 2 || stride_ == 4, "2 or 4 in mode " + mode_);
        require(filter_ == "NONE", MessageId::Conflict,
                {part::place(place_ + ".filter"), " is ", part::quoted(filter_), "; expected ", part::expected("NONE in mode " + mode_)});
        require(mode_ != "TRIANGLES" || count_ % 3 == 0, MessageId::OutOfRange,
                {part::place(place_ + ".count"), " is ", part::value(std::to_string(count_)), "; expected ",
                 part::expected("a multiple of 3 in mode TRIANGLES")});
    }

    const std::string& path_;
    std::string place_, mode_, filter_;
    std::uint64_t count_, stride_;
};

}  // namespace

void decompressViews(const std::string& path, json& document, std::uint64_t ownBytes, Buffers& buffers)
{
    json none = json::array();
    json& views = document.contains("bufferViews") ? document["bufferViews"] : none;
    std::uint64_t room = kFewBytes + kDecodedPerByte * ownBytes;  // views may overlap
    for (std::size_t i = 0; i < views.size(); ++i) {
        json& view = views[i];
        for (const std::string name : kMeshoptExtensions) {
            if (!view.contains("extensions") || !view["extensions"].contains(name)) {
                continue;
            }
            const json& source = view["extensions"][name];
            const std::string place = "bufferViews[" + std::to_string(i) + "].extensions." + name;
            const ViewDecoder decoder(path, place, source);
            const std::span<const unsigned char> bytes = findBytes(path, buffers, getRange(source), place);
            const auto length = view["byteLength"].get<std::uint64_t>();
            decoder.checkSize(length, bytes.size());
            if (length > room) {
                refuse(path, MessageId::TooLarge,
                       {part::place(place), " claims ", part::value(std::to_string(length)), " bytes; expected ",
                        part::expected("at most the " + std::to_string(room) + " that are left for a file of this size")});
            }
            room -= length;
            buffers.push_back(decoder.decode(bytes));
            view["buffer"] = buffers.size() - 1;
            view["byteOffset"] = 0;
            view.erase("extensions");
        }
    }
}

}  // namespace glim
