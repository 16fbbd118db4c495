#include "host/scene/gltf/edit_gltf.hpp"

#include "host/error.hpp"
#include "host/scene/gltf/check_gltf_json.hpp"
#include "host/scene/gltf/gltf_container.hpp"
#include "host/scene/gltf/gltf_schema.hpp"
#include "host/scene/gltf/object_model.hpp"
#include "host/scene/gltf/parse_model.hpp"
#include "host/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace glim {
namespace {

using nlohmann::json;

constexpr std::array kChangeable{
    "nodes[].", "materials[].", "cameras[].", "meshes[].weights", "images[].uri", "extensions.KHR_lights_punctual.lights[].",
};

class Editor {
public:
    Editor(const std::string& path, json& document, const Edit& edit)
        : path_(path),
          document_(document),
          edit_(edit)
    {}

    void apply()
    {
        std::vector<std::string> steps = splitPointer(edit_.pointer);
        json* at = &document_;
        for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
            at = &enter(*at, steps, i);
        }
        const std::string schemaPath = makeSchemaPath(steps);
        checkProperty(steps, schemaPath);
        if (at->is_array() && follow(*at, steps.back()) == nullptr) {
            refuseIndex(*at, steps, steps.size() - 1);
        }
        settleTransform(*at, schemaPath, steps.back());
        json value = json::parse(edit_.value, nullptr, false);
        if (value.is_discarded()) {
            refuse(MessageId::Malformed, {part::quoted(edit_.value), " is not JSON; expected ",
                                          part::expected("a number, a list of numbers, true, false or a word in quotes")});
        }
        if (schemaPath == "images[].uri") {
            if (value == "") {
                refuse(MessageId::Malformed, {part::quoted(""), " is no uri; expected ", part::expected("the name of a file, or data:")});
            }
            for (const char* member : {"bufferView", "mimeType"}) {  // of what is no longer drawn
                at->erase(member);
            }
        }
        (at->is_array() ? (*at)[std::stoul(steps.back())] : (*at)[steps.back()]) = std::move(value);
    }

private:
    [[noreturn]] void refuse(MessageId id, std::initializer_list<MessagePart> why) const
    {
        const Message message(id, why);
        throw InputError(Message(message, {part::file(path_), ": --set ", part::place(edit_.pointer), ": ", message.sentence, "."}));
    }

    // The pointer up to a step.
    static std::string placeOf(const std::vector<std::string>& steps, std::size_t count)
    {
        std::string place;
        for (std::size_t i = 0; i < count; ++i) {
            place += "/" + steps[i];
        }
        return place;
    }

    static std::string indicesOf(const json& list)
    {
        return list.empty() ? "no elements" : "an index from 0 to " + std::to_string(list.size() - 1);
    }

    [[noreturn]] void refuseIndex(const json& list, const std::vector<std::string>& steps, std::size_t step) const
    {
        const std::string place = placeOf(steps, step), count = counted(list.size(), "element");
        if (list.empty()) {
            refuse(MessageId::DanglingIndex, {part::value(place), " has ", count});
        }
        refuse(MessageId::DanglingIndex,
               {part::value(place), " has ", count, "; expected ", part::expected(indicesOf(list) + ", or a name")});
    }

    // What step i leads to, below `at`. An index takes the place of a name.
    json& enter(json& at, std::vector<std::string>& steps, std::size_t i) const
    {
        std::string& step = steps[i];
        if (at.is_array() && !isIndex(step)) {
            step = std::to_string(indexOf(at, placeOf(steps, i), step));
        }
        if (json* below = follow(at, step)) {
            return *below;
        }
        if (at.is_array()) {
            refuseIndex(at, steps, i);
        }
        if (!at.is_object() || isIndex(steps[i + 1])) {
            refuse(MessageId::UnknownName,
                   {"the file has no ", part::value(placeOf(steps, i + 1)), "; expected ",
                    part::expected("a pointer into nodes, materials, cameras, meshes, images or extensions/KHR_lights_punctual/lights")});
        }
        return at[step] = json::object();
    }

    std::size_t indexOf(const json& list, const std::string& place, const std::string& name) const
    {
        std::vector<std::size_t> found;
        std::string names;
        std::size_t named = 0;
        for (std::size_t i = 0; i < list.size(); ++i) {
            const json* const given = list[i].is_object() && list[i].contains("name") ? &list[i]["name"] : nullptr;
            const std::string own = given != nullptr && given->is_string() ? given->get<std::string>() : std::string();
            if (own == name) {
                found.push_back(i);
            }
            if (!own.empty() && named++ < kMaxListed) {
                names += (names.empty() ? "" : ", ") + inQuotes(own);
            }
        }
        if (found.size() == 1) {
            return found.front();
        }
        if (found.empty()) {
            refuse(MessageId::UnknownName,
                   {"no element of ", place, " is named ", part::quoted(name), "; expected ",
                    part::expected(indicesOf(list) + (names.empty() ? std::string() : ", or one of " + names + moreThanListed(named)))});
        }
        std::string indices;
        for (std::size_t i = 0; i < std::min(found.size(), kMaxListed); ++i) {
            indices += (i == 0 ? "" : ", ") + std::to_string(found[i]);
        }
        refuse(MessageId::AmbiguousName, {counted(found.size(), "element"), " of ", place, " are named ", part::quoted(name), "; expected ",
                                          part::expected("one of their indices, " + indices + moreThanListed(found.size()))});
    }

    void checkProperty(const std::vector<std::string>& steps, const std::string& schemaPath) const
    {
        const bool allWeights = schemaPath == "nodes[].weights" || schemaPath == "meshes[].weights";
        const SchemaRule* rule = findRule(allWeights ? schemaPath + "[]" : schemaPath);
        const bool hasValue =
            rule != nullptr && (rule->kind == JsonKind::Number || rule->kind == JsonKind::Numbers || rule->kind == JsonKind::Bool ||
                                rule->kind == JsonKind::OneOf || schemaPath == "images[].uri");
        const bool isChangeable = std::ranges::any_of(kChangeable, [&](const char* start) { return schemaPath.starts_with(start); });
        if (steps.empty() || !hasValue || !isChangeable || steps.back() == "type") {
            refuse(MessageId::Unsupported,
                   {"is not a value that glim can change; expected ",
                    part::expected(
                        "a number, boolean or word of a node, material, camera or light, the weights of a mesh, or the uri of an image, "
                        "as in /materials/0/pbrMetallicRoughness/roughnessFactor")});
        }
    }

    // A node has a matrix or its parts, never both.
    void settleTransform(json& parent, const std::string& schemaPath, const std::string& name) const
    {
        if (schemaPath == "nodes[].matrix") {
            for (const char* part : {"translation", "rotation", "scale"}) {
                parent.erase(part);
            }
        }
        const bool isPart = schemaPath == "nodes[]." + name && (name == "translation" || name == "rotation" || name == "scale");
        if (isPart && parent.contains("matrix") && !splitMatrix(parent)) {
            refuse(MessageId::Degenerate,
                   {"the node's matrix shears, flattens or projects and cannot be split into translation, rotation and scale; expected ",
                    part::expected("an edit of the node's matrix")});
        }
    }

    const std::string& path_;
    json& document_;
    const Edit& edit_;
};

// `document` after the edits, checked.
json editDocument(const std::string& path, json document, std::span<const Edit> edits, Warnings& warnings)
{
    for (const Edit& edit : edits) {
        Editor(path, document, edit).apply();
        checkGltfJson(path, document, warnings);
    }
    return document;
}

json readDocument(const std::string& path)
{
    Warnings unheard;  // the file's reader says them
    json document = parseJson(path, openContainer(path).json);
    checkGltfJson(path, document, unheard);
    return document;
}

// `to` with the parts of `document` that edits may change, but for the weights of meshes and the images.
json copyParts(const json& document, json to)
{
    for (const char* part : {"nodes", "materials", "cameras", "extensions"}) {
        if (document.contains(part)) {
            to[part] = document[part];
        }
    }
    return to;
}

std::string uriOf(const json& document, std::size_t image) { return document["images"][image].value("uri", ""); }

// The file's images, but for those to which edits give another uri.
std::vector<EncodedImage> listEdited(const GltfFile& file, const json& document)
{
    std::vector<EncodedImage> images = file.ownImages;
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (const std::string uri = uriOf(document, i); uri != uriOf(*file.original, i)) {
            if (file.confined && !isDataUri(uri)) {
                refuseOutside(file.path, label("images", i, images[i].name), uri);
            }
            images[i] = {images[i].name, uri, std::nullopt};
        }
    }
    return images;
}

}  // namespace

std::vector<std::size_t> editGltf(GltfFile& file, std::span<const Edit> edits)
{
    if (edits.empty() && !file.original) {
        return {};
    }
    if (!file.original) {
        file.original = std::make_shared<const json>(readDocument(file.path));
        file.ownImages = file.images;
    }
    Warnings warnings;
    const json document = editDocument(file.path, *file.original, edits, warnings);
    std::vector<EncodedImage> images = listEdited(file, document);
    tinygltf::Model changed = parseModel(file.path, copyParts(document, {{"asset", document["asset"]}}));
    file.editWarnings = std::move(warnings);
    file.model.nodes = std::move(changed.nodes);
    file.model.materials = std::move(changed.materials);
    file.model.cameras = std::move(changed.cameras);
    file.model.lights = std::move(changed.lights);
    file.model.extensions = std::move(changed.extensions);
    for (std::size_t i = 0; i < file.model.meshes.size(); ++i) {
        file.model.meshes[i].weights = document["meshes"][i].value("weights", std::vector<double>());
    }
    if (file.document) {
        json whole = copyParts(document, *file.document);
        for (std::size_t i = 0; i < file.model.meshes.size(); ++i) {
            if (document["meshes"][i].contains("weights")) {
                whole["meshes"][i]["weights"] = document["meshes"][i]["weights"];
            } else {
                whole["meshes"][i].erase("weights");
            }
        }
        file.document = std::make_shared<const json>(std::move(whole));
    }
    file.images.swap(images);
    std::vector<std::size_t> replaced;
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (images[i].uri != file.images[i].uri) {
            replaced.push_back(i);
        }
    }
    return replaced;
}

struct EditableFile::Contents {
    std::string path;
    json document;
};

EditableFile::EditableFile(const std::filesystem::path& file)
{
    json document = readDocument(file.string());
    for (const char* list : {"buffers", "images"}) {  // whose data no edit needs, and every edit would copy
        if (document.contains(list)) {
            for (json& element : document[list]) {
                element.erase("uri");
            }
        }
    }
    contents_ = std::make_shared<const Contents>(Contents{file.string(), std::move(document)});
}

std::vector<std::string> EditableFile::namesAt(const std::string& list) const
{
    std::vector<std::string> names;
    for (const json& element : contents_->document.value(json::json_pointer(list), json::array())) {
        names.push_back(element.value("name", ""));
    }
    return names;
}

std::optional<std::size_t> EditableFile::imageOf(std::size_t texture) const
{
    return glim::imageOf(contents_->document.at("textures").at(texture));
}

std::string EditableFile::valueAt(const std::string& pointer, const std::vector<Edit>& edits) const
{
    Warnings unheard;
    json value = editDocument(contents_->path, contents_->document, edits, unheard).at(json::json_pointer(pointer));
    if (value.contains("matrix")) {
        json parts = value;
        if (splitMatrix(parts)) {
            value.update(parts);
        }
    }
    return value.dump();
}

}  // namespace glim
