#include "host/scene/gltf/parse_model.hpp"

#include "host/error.hpp"

#include <nlohmann/json.hpp>

namespace glim {
namespace {

using nlohmann::json;

// tinygltf 2.7 refuses index accessors without a bufferView, though they may lack it. They borrow an additional one, the last, while it
// parses. Returns the borrowers.
std::vector<std::size_t> lendBufferView(json& document)
{
    std::vector<std::size_t> borrowers;
    if (!document.contains("accessors") || document["accessors"].empty()) {
        return borrowers;
    }
    json& views = document["bufferViews"];
    for (std::size_t i = 0; i < document["accessors"].size(); ++i) {
        json& accessor = document["accessors"][i];
        if (!accessor.contains("bufferView")) {
            accessor["bufferView"] = views.size();
            borrowers.push_back(i);
        }
    }
    views.push_back({{"buffer", 0}, {"byteLength", 1}});
    return borrowers;
}

// tinygltf refuses strides that are no multiple of 4, which indices and packed small integers have.
std::vector<std::size_t> takeStrides(json& document)
{
    std::vector<std::size_t> strides;
    if (document.contains("bufferViews")) {
        for (json& view : document["bufferViews"]) {
            strides.push_back(view.value("byteStride", std::size_t{0}));
            view.erase("byteStride");
        }
    }
    return strides;
}

// tinygltf narrows whole numbers in extras and extensions to int.
void widenIntegers(json& value)
{
    if (value.is_number_integer()) {
        value = value.get<double>();
    } else if (value.is_structured()) {
        for (json& member : value) {
            widenIntegers(member);
        }
    }
}

void widenMembers(json& document, const char* collection, const char* member)
{
    if (!document.contains(collection)) {
        return;
    }
    for (json& element : document[collection]) {
        if (element.contains(member)) {
            widenIntegers(element[member]);
        }
    }
}

}  // namespace

// tinygltf gets nothing but checked JSON: it opens no file, decodes no image, and cannot stumble over what glim does not read. The JSON
// is parsed twice, before the checks and again by tinygltf, because tinygltf accepts only text, checks little of it, and does not expose
// the document that it has parsed.
tinygltf::Model parseModel(const std::string& path, json document)
{
    const std::vector<std::size_t> strides = takeStrides(document), borrowers = lendBufferView(document);
    widenMembers(document, "materials", "extensions");
    widenMembers(document, "nodes", "extras");
    if (document.contains("meshes")) {
        for (json& mesh : document["meshes"]) {
            widenMembers(mesh, "primitives", "extras");
        }
    }
    const std::string text = document.dump();
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    std::string error, warning;
    if (!parser.LoadASCIIFromString(&model, &error, &warning, text.data(), static_cast<unsigned>(text.size()), "")) {
        throw InputError(MessageId::Malformed, {part::file(path), ": not valid glTF: ", error.substr(0, error.find('\n'))});
    }
    for (const std::size_t borrower : borrowers) {
        model.accessors[borrower].bufferView = -1;
    }
    if (!model.accessors.empty()) {
        model.bufferViews.pop_back();
    }
    for (std::size_t i = 0; i < strides.size(); ++i) {
        model.bufferViews[i].byteStride = strides[i];
    }
    return model;
}

}  // namespace glim
