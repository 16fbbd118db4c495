#include "host/error.hpp"
#include "host/input_file.hpp"
#include "host/message.hpp"
#include "host/scene/gltf/check_gltf_json.hpp"
#include "host/scene/gltf/decompress.hpp"
#include "host/scene/gltf/gltf_container.hpp"
#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/gltf/gltf_schema.hpp"
#include "host/scene/gltf/parse_model.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

namespace glim {
namespace {

using nlohmann::json;

// `%20` and its like, RFC 3986 section 2.1.
std::string percentDecode(const std::string& uri)
{
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[i + 1])) != 0 &&
            std::isxdigit(static_cast<unsigned char>(uri[i + 2])) != 0) {
            decoded += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
            i += 2;
        } else {
            decoded += uri[i];
        }
    }
    return decoded;
}

std::optional<std::uint32_t> base64Digit(char c)
{
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t digit = kDigits.find(c == '-' ? '+' : c == '_' ? '/' : c);
    return digit == std::string_view::npos ? std::nullopt : std::optional(static_cast<std::uint32_t>(digit));
}

// RFC 4648, with or without "=" at its end. `place` names the uri.
std::vector<unsigned char> decodeBase64(const std::string& path, const std::string& place, std::string_view data)
{
    const std::size_t end = data.find_last_not_of('=');
    const std::size_t size = end == std::string_view::npos ? 0 : end + 1;
    if (data.size() - size > 2 || size % 4 == 1) {
        throw InputError(MessageId::Malformed,
                         {part::file(path), ": ", part::place(place), " has data of ", part::value(std::to_string(size)), " digits and ",
                          std::to_string(data.size() - size), " equals signs; expected ", part::expected("base64")});
    }
    std::vector<unsigned char> bytes;
    bytes.reserve(size / 4 * 3);
    std::uint32_t group = 0, digits = 0;
    for (const char c : data.substr(0, size)) {
        const std::optional<std::uint32_t> digit = base64Digit(c);
        if (!digit) {
            throw InputError(MessageId::Malformed, {part::file(path), ": ", part::place(place), " has the byte ",
                                                    part::value(std::to_string(static_cast<unsigned char>(c))), " in its data; expected ",
                                                    part::expected("base64")});
        }
        group = group << 6U | *digit;
        if (++digits % 4 == 0) {
            bytes.insert(bytes.end(), {static_cast<unsigned char>(group >> 16U & 255U), static_cast<unsigned char>(group >> 8U & 255U),
                                       static_cast<unsigned char>(group & 255U)});
        }
    }
    if (digits % 4 >= 2) {
        group <<= 6U * (4 - digits % 4);
        bytes.push_back(static_cast<unsigned char>(group >> 16U & 255U));
        if (digits % 4 == 3) {
            bytes.push_back(static_cast<unsigned char>(group >> 8U & 255U));
        }
    }
    return bytes;
}

// RFC 2397, of any media type: base64 or, without the word, text.
std::vector<unsigned char> decodeDataUri(const std::string& path, const std::string& place, const std::string& uri)
{
    constexpr std::string_view kBase64 = ";base64";
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos) {
        throw InputError(MessageId::Malformed, {part::file(path), ": ", part::place(place + ".uri"), " is ", part::quoted(uri),
                                                "; expected ", part::expected("a comma between the media type and the data")});
    }
    const std::string_view header = std::string_view(uri).substr(0, comma);
    const bool isBase64 = header.size() >= kBase64.size() && header.substr(header.size() - kBase64.size()) == kBase64;
    const bool isEncoded = !isBase64 || uri.find('%', comma) != std::string::npos;
    const std::string decoded = isEncoded ? percentDecode(uri.substr(comma + 1)) : "";
    if (!isBase64) {
        return {decoded.begin(), decoded.end()};
    }
    return decodeBase64(path, place + ".uri", isEncoded ? std::string_view(decoded) : std::string_view(uri).substr(comma + 1));
}

// The names of files that a uri may mean.
std::array<std::string, 3> namesOf(const std::string& uri)
{
    const std::string decoded = percentDecode(uri);
    std::string slashed = decoded;
    std::replace(slashed.begin(), slashed.end(), '\\', '/');
    return {uri, decoded, slashed};
}

bool isRelative(const std::string& name)
{
    return !name.empty() && !std::filesystem::path(name).is_absolute() && name.find('\0') == std::string::npos;
}

std::vector<unsigned char> readExternal(const std::string& path, const std::string& place, const std::string& uri, std::uint64_t most)
{
    const std::array<std::string, 3> names = namesOf(uri);
    const bool url = isUrl(uri);
    if (url || !std::all_of(names.begin(), names.end(), isRelative)) {
        throw InputError(
            url ? MessageId::Unsupported : MessageId::Malformed,
            {part::file(path), ": ", part::place(place + ".uri"), " is ", part::quoted(uri), "; expected ",
             part::expected("a path relative to the glTF file" + std::string(url ? ", as glim reads files and no URLs" : ""))});
    }
    try {
        return readBytes(externalFile(path, uri), most);
    } catch (const InputError& error) {
        throw InputError(error, {part::file(path), ": ", part::place(place), " names the file ", part::quoted(uri),
                                 ", which cannot be read (", error.what(), ")"});
    }
}

// Holds nothing but what readers that cannot decompress would need.
bool isFallback(const json& buffer)
{
    const json extensions = buffer.value("extensions", json::object());
    return std::any_of(std::begin(kMeshoptExtensions), std::end(kMeshoptExtensions),
                       [&](const char* name) { return extensions.value(name, json::object()).value("fallback", false); });
}

// How many bytes of each buffer its views can reach: more than these need not be read, and a file may claim many.
std::vector<std::uint64_t> listEnds(const json& document)
{
    std::vector<std::uint64_t> ends(document.value("buffers", json::array()).size(), 0);
    const auto extend = [&ends](const json& view) {
        const BufferRange range = getRange(view);
        ends[range.buffer] = std::max(ends[range.buffer], range.offset + range.length);
    };
    for (const json& view : document.value("bufferViews", json::array())) {
        extend(view);
        const json extensions = view.value("extensions", json::object());
        for (const char* name : kMeshoptExtensions) {
            if (extensions.contains(name)) {
                extend(extensions[name]);
            }
        }
    }
    return ends;
}

// Refuses a file that is shorter than its buffer, whatever part of it is read.
void checkLength(const std::string& path, const std::string& place, std::uint64_t found, std::uint64_t expected)
{
    if (found < expected) {
        throw InputError(MessageId::FileDamaged, {part::file(path), ": ", part::place(place), " holds ", part::value(std::to_string(found)),
                                                  " bytes; expected ", part::expected("its byteLength " + std::to_string(expected))});
    }
}

std::uint64_t getFileSize(const std::filesystem::path& file)
{
    std::error_code unreadable;
    const std::uintmax_t length = std::filesystem::file_size(file, unreadable);
    return unreadable ? 0 : length;
}

Buffers readBuffers(const std::string& path, const json& document, const GltfContainer& container)
{
    Buffers buffers;
    const std::vector<std::uint64_t> ends = listEnds(document);
    for (const json& entry : document.value("buffers", json::array())) {
        const std::string place = "buffers[" + std::to_string(buffers.size()) + "]";
        const auto expected = entry.at("byteLength").get<std::uint64_t>();
        const std::uint64_t needed = std::min(expected, ends[buffers.size()]);
        const std::string uri = entry.value("uri", "");
        std::vector<unsigned char> bytes;
        if (isFallback(entry)) {
            buffers.emplace_back();
            continue;
        }
        if (!entry.contains("uri") && expected > 0) {
            if (!buffers.empty() || !container.binary) {
                throw InputError(MessageId::Missing, {part::file(path), ": ", part::place(place), " has no uri; expected ",
                                                      part::expected("one in all but the first buffer of a .glb")});
            }
            checkLength(path, place, container.binary->size, expected);
            bytes = readBytes(path, needed, container.binary->begin);
        } else if (expected > 0) {
            bytes = readUri(path, place, uri, needed);
            checkLength(path, place, isDataUri(uri) ? bytes.size() : getFileSize(externalFile(path, uri)), expected);
        }
        buffers.push_back(std::move(bytes));
    }
    return buffers;
}

std::vector<std::filesystem::path> listFiles(const std::string& path, const json& document)
{
    std::vector<std::filesystem::path> files{path};
    for (const json& buffer : document.value("buffers", json::array())) {
        const std::string uri = buffer.value("uri", "data:");
        if (!isDataUri(uri) && !isFallback(buffer)) {
            files.push_back(externalFile(path, uri));
        }
    }
    return files;
}

std::vector<EncodedImage> listImages(const json& document)
{
    std::vector<EncodedImage> images;
    for (const json& entry : document.value("images", json::array())) {
        EncodedImage image{entry.value("name", ""), entry.value("uri", ""), std::nullopt};
        if (entry.contains("bufferView")) {
            const json& view = document["bufferViews"][entry["bufferView"].get<std::size_t>()];
            image.range = getRange(view);
        }
        images.push_back(std::move(image));
    }
    return images;
}

constexpr int kNearest = 9728, kLinear = 9729, kNearestMipmapNearest = 9984, kLinearMipmapNearest = 9985, kNearestMipmapLinear = 9986,
              kLinearMipmapLinear = 9987;
constexpr int kRepeat = 10497, kClampToEdge = 33071, kMirroredRepeat = 33648;

Wrap wrapOf(const json& sampler, const char* member)
{
    const int value = sampler.value(member, kRepeat);
    return value == kClampToEdge ? Wrap::Clamp : value == kMirroredRepeat ? Wrap::Mirrored : Wrap::Repeat;
}

// Where there is no magFilter, magnification is bilinear; of minFilter only the filter within a level counts, and only without a magFilter.
bool isNearest(const json& sampler)
{
    const int filter = sampler.value("magFilter", sampler.value("minFilter", kLinear));
    return filter == kNearest || filter == kNearestMipmapNearest || filter == kNearestMipmapLinear;
}

// Filters and wraps of no meaning to glTF are those of its defaults; a magFilter with mipmaps is the filter within a level.
void warnOfSamplers(const json& document, Warnings& warnings)
{
    constexpr int kUnset = 0;
    const std::pair<const char*, std::vector<int>> members[] = {
        {"magFilter", {kUnset, kNearest, kLinear}},
        {"minFilter", {kUnset, kNearest, kLinear, kNearestMipmapNearest, kLinearMipmapNearest, kNearestMipmapLinear, kLinearMipmapLinear}},
        {"wrapS", {kUnset, kRepeat, kClampToEdge, kMirroredRepeat}},
        {"wrapT", {kUnset, kRepeat, kClampToEdge, kMirroredRepeat}},
    };
    std::size_t index = 0;
    for (const json& sampler : document.value("samplers", json::array())) {
        for (const auto& [member, known] : members) {
            const int value = sampler.value(member, kUnset);
            if (std::find(known.begin(), known.end(), value) == known.end()) {
                warnings.add(MessageId::UnknownSampler,
                             "filters and wraps that glTF does not know there count as the nearest that it knows",
                             "samplers[" + std::to_string(index) + "]." + member + " " + std::to_string(value));
            }
        }
        ++index;
    }
}

std::vector<GltfTexture> listTextures(const json& document)
{
    std::vector<GltfTexture> textures;
    for (const json& entry : document.value("textures", json::array())) {
        const json sampler = entry.contains("sampler") ? document["samplers"][entry["sampler"].get<std::size_t>()] : json::object();
        GltfTexture texture;
        texture.name = entry.value("name", "");
        texture.wrapS = wrapOf(sampler, "wrapS");
        texture.wrapT = wrapOf(sampler, "wrapT");
        texture.nearest = isNearest(sampler);
        texture.image = imageOf(entry);
        textures.push_back(std::move(texture));
    }
    return textures;
}

std::vector<GltfSkin> listSkins(const json& document)
{
    std::vector<GltfSkin> skins;
    for (const json& entry : document.value("skins", json::array())) {
        GltfSkin skin{entry.value("name", ""), entry["joints"].get<std::vector<std::size_t>>(), std::nullopt};
        if (entry.contains("inverseBindMatrices")) {
            skin.inverseBindMatrices = entry["inverseBindMatrices"].get<std::size_t>();
        }
        skins.push_back(std::move(skin));
    }
    return skins;
}

GltfAnimation listAnimation(const json& entry)
{
    GltfAnimation animation;
    animation.name = entry.value("name", "");
    for (const json& source : entry["samplers"]) {
        const std::string interpolation = source.value("interpolation", "LINEAR");
        animation.samplers.push_back({source["input"].get<std::size_t>(), source["output"].get<std::size_t>(),
                                      interpolation == "STEP"     ? Interpolation::Step
                                      : interpolation == "LINEAR" ? Interpolation::Linear
                                                                  : Interpolation::CubicSpline});
    }
    for (const json& source : entry["channels"]) {
        const json& target = source["target"];
        const std::string path = target["path"].get<std::string>();
        GltfAnimation::Channel channel{source["sampler"].get<std::size_t>(), ""};
        if (path == "pointer") {
            channel.pointer = target.value(json::json_pointer("/extensions/KHR_animation_pointer/pointer"), "");
        } else if (target.contains("node")) {
            channel.pointer = "/nodes/" + target["node"].dump() + "/" + path;
        }
        animation.channels.push_back(std::move(channel));
    }
    return animation;
}

std::vector<GltfAnimation> listAnimations(const json& document)
{
    std::vector<GltfAnimation> animations;
    for (const json& entry : document.value("animations", json::array())) {
        animations.push_back(listAnimation(entry));
    }
    return animations;
}

void confine(const std::string& path, const json& document)
{
    for (const char* list : {"buffers", "images"}) {
        std::size_t index = 0;
        for (const json& entry : document.value(list, json::array())) {
            const std::string uri = entry.value("uri", "data:");
            if (!isDataUri(uri)) {
                refuseOutside(path, std::string(list) + "[" + std::to_string(index) + "]", uri);
            }
            ++index;
        }
    }
}

}  // namespace

GltfFile readGltfFile(const std::filesystem::path& file, bool confined)
{
    const std::string path = file.string();
    GltfContainer container = openContainer(file);
    json document = parseJson(path, container.json);
    GltfFile result;
    checkGltfJson(path, document, result.warnings);
    if (confined) {
        confine(path, document);
    }

    result.path = path;
    result.confined = confined;
    result.buffers = readBuffers(path, document, container);
    result.files = listFiles(path, document);
    result.ownBuffers = result.buffers.size();
    result.ownBytes = std::accumulate(result.buffers.begin(), result.buffers.end(), std::uint64_t{container.json.size()},
                                      [](std::uint64_t sum, const std::vector<unsigned char>& buffer) { return sum + buffer.size(); });
    decompressViews(path, document, result.ownBytes, result.buffers);
    decompressPrimitives(path, document, result.ownBytes, result.buffers);
    warnOfSamplers(document, result.warnings);
    result.images = listImages(document);
    result.textures = listTextures(document);
    result.skins = listSkins(document);
    result.animations = listAnimations(document);
    for (const char* listed : {"buffers", "images", "textures", "samplers", "skins", "animations"}) {
        document.erase(listed);
    }
    if (!result.animations.empty()) {
        result.document = std::make_shared<const json>(document);
    }
    result.model = parseModel(path, std::move(document));
    return result;
}

// The image of an extension goes before the texture's own, which is there for readers that do not know the extension. Images of kinds that
// glim does not know come last: they are refused with their names, or drawn grey.
std::optional<std::size_t> imageOf(const json& texture)
{
    const json extensions = texture.value("extensions", json::object());
    const auto extension = [&extensions](const char* name) { return extensions.value(name, json::object()); };
    for (const json& holder : {extension("EXT_texture_webp"), extension("KHR_texture_basisu"), texture, extension("EXT_texture_avif"),
                               extension("MSFT_texture_dds")}) {
        if (holder.contains("source")) {
            return holder["source"].get<std::size_t>();
        }
    }
    return std::nullopt;
}

bool isDataUri(const std::string& uri) { return uri.rfind("data:", 0) == 0; }

std::filesystem::path externalFile(const std::string& path, const std::string& uri)
{
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    const std::array<std::string, 3> names = namesOf(uri);
    std::error_code unreadable;
    const auto* const found = std::find_if(names.begin(), names.end(),
                                           [&](const std::string& name) { return std::filesystem::exists(folder / name, unreadable); });
    return folder / (found == names.end() ? names[1] : *found);
}

void refuseOutside(const std::string& path, const std::string& place, const std::string& uri)
{
    std::error_code unreadable;  // such a file is refused later, with its reason
    const std::filesystem::path file = std::filesystem::weakly_canonical(externalFile(path, uri), unreadable);
    const std::filesystem::path folder = std::filesystem::weakly_canonical(std::filesystem::absolute(path).parent_path(), unreadable);
    if (std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first != folder.end()) {
        throw InputError(MessageId::OutsideFolder, {part::file(path), ": ", part::place(place), " names the file ", part::quoted(uri),
                                                    "; expected ", part::expected("one in the folder of the scene (--confine)")});
    }
}

std::vector<unsigned char> readUri(const std::string& path, const std::string& place, const std::string& uri, std::uint64_t most)
{
    return isDataUri(uri) ? decodeDataUri(path, place, uri) : readExternal(path, place, uri, most);
}

BufferRange getRange(const json& view)
{
    return {view["buffer"].get<std::size_t>(), view.value("byteOffset", std::uint64_t{0}), view["byteLength"].get<std::uint64_t>()};
}

std::span<const unsigned char> findBytes(const std::string& path, const Buffers& buffers, const BufferRange& range,
                                         const std::string& place)
{
    const std::vector<unsigned char>& buffer = buffers[range.buffer];
    if (range.offset > buffer.size() || range.length > buffer.size() - range.offset) {
        throw InputError(MessageId::OutOfRange, {part::file(path), ": ", part::place(place), " ends at byte ",
                                                 part::value(std::to_string(range.offset + range.length)), "; expected ",
                                                 part::expected("at most the " + std::to_string(buffer.size()) + " of buffers[" +
                                                                std::to_string(range.buffer) + "]")});
    }
    return std::span(buffer).subspan(range.offset, range.length);
}

void refuse(const std::string& path, MessageId id, std::initializer_list<MessagePart> words)
{
    const Message message(id, words);
    throw InputError(Message(message, {part::file(path), ": ", message.sentence}));
}

void refuse(const GltfFile& file, MessageId id, std::initializer_list<MessagePart> words) { refuse(file.path, id, words); }

std::string label(const char* collection, std::size_t index, const std::string& name)
{
    const std::string place = std::string(collection) + "[" + std::to_string(index) + "]";
    return name.empty() ? place : place + " (" + inQuotes(name) + ")";
}

std::string nodeLabel(const GltfFile& file, std::size_t node) { return label("nodes", node, file.model.nodes[node].name); }

std::string toText(double value)
{
    std::ostringstream text;
    text << value;
    return text.str();
}

}  // namespace glim
