#include "host/scene/gltf/edit_gltf.hpp"

#include "host/error.hpp"
#include "host/scene/gltf/check_gltf_json.hpp"
#include "host/scene/gltf/gltf_schema.hpp"
#include "host/scene/gltf/object_model.hpp"
#include "host/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace glim {
namespace {

using nlohmann::json;

constexpr std::array kChangeable{"nodes[].", "materials[].", "cameras[].", "meshes[].weights", "extensions.KHR_lights_punctual.lights[]."};

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
            at = &enter(*at, steps[i], steps[i + 1]);
        }
        const std::string schemaPath = schemaPathOf(steps);
        checkProperty(steps, schemaPath);
        if (at->is_array() && follow(*at, steps.back()) == nullptr) {
            refuse("the file has " + counted(at->size(), "element") + " there; expected an index below that");
        }
        settleTransform(*at, schemaPath, steps.back());
        json value = json::parse(edit_.value, nullptr, false);
        if (value.is_discarded()) {
            refuse(inQuotes(edit_.value) + " is not JSON; expected a number, a list of numbers, true, false or a word in quotes");
        }
        (at->is_array() ? (*at)[std::stoul(steps.back())] : (*at)[steps.back()]) = std::move(value);
    }

private:
    [[noreturn]] void refuse(const std::string& why) const { throw InputError(path_ + ": --set " + edit_.pointer + ": " + why + "."); }

    // What is below `at`. An index takes the place of a name.
    json& enter(json& at, std::string& step, const std::string& next) const
    {
        if (at.is_array() && !isIndex(step)) {
            step = std::to_string(indexOf(at, step));
        }
        if (json* below = follow(at, step)) {
            return *below;
        }
        if (at.is_array()) {
            refuse("the file has " + counted(at.size(), "element") + " there; expected an index below that, or a name");
        }
        if (!at.is_object() || isIndex(next)) {
            refuse("the file has no " + step + " there; expected a property that it has");
        }
        return at[step] = json::object();
    }

    std::size_t indexOf(const json& list, const std::string& name) const
    {
        std::vector<std::size_t> found;
        std::string names;
        std::size_t named = 0;
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string own = list[i].is_object() ? list[i].value("name", "") : "";
            if (own == name) {
                found.push_back(i);
            }
            if (!own.empty() && named++ < kMostListed) {
                names += (names.empty() ? "" : ", ") + inQuotes(own);
            }
        }
        if (found.size() == 1) {
            return found.front();
        }
        if (found.empty()) {
            refuse("nothing there is named " + inQuotes(name) + "; expected an index" +
                   (names.empty() ? std::string() : ", or one of " + names + moreThanListed(named)));
        }
        std::string indices;
        for (std::size_t i = 0; i < std::min(found.size(), kMostListed); ++i) {
            indices += (i == 0 ? "" : ", ") + std::to_string(found[i]);
        }
        refuse(counted(found.size(), "thing") + " there are named " + inQuotes(name) + "; expected one of their indices, " + indices +
               moreThanListed(found.size()));
    }

    void checkProperty(const std::vector<std::string>& steps, const std::string& schemaPath) const
    {
        const bool allWeights = schemaPath == "nodes[].weights" || schemaPath == "meshes[].weights";
        const SchemaRule* rule = findRule(allWeights ? schemaPath + "[]" : schemaPath);
        const bool hasValue = rule != nullptr && (rule->kind == JsonKind::Number || rule->kind == JsonKind::Numbers ||
                                                  rule->kind == JsonKind::Bool || rule->kind == JsonKind::OneOf);
        const bool isChangeable = std::ranges::any_of(kChangeable, [&](const char* start) { return schemaPath.starts_with(start); });
        if (steps.empty() || !hasValue || !isChangeable || steps.back() == "type") {
            refuse(
                "names nothing that glim can change; expected a pointer to a value, as in "
                "/materials/0/pbrMetallicRoughness/roughnessFactor");
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
            refuse("the node has a matrix that shears or flattens; expected an edit of all of it, the node's matrix");
        }
    }

    const std::string& path_;
    json& document_;
    const Edit& edit_;
};

}  // namespace

void editGltf(const std::string& path, json& document, std::span<const Edit> edits)
{
    for (const Edit& edit : edits) {
        Editor(path, document, edit).apply();
    }
}

}  // namespace glim
