#include "host/scene/gltf/check_gltf_json.hpp"

#include "host/error.hpp"
#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/gltf/gltf_schema.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string_view>

namespace glim {
namespace {

using nlohmann::json;

constexpr const char* kSupportedExtensions[] = {
    "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_ior",  "KHR_materials_specular",
    "KHR_materials_transmission", "KHR_materials_volume",     "KHR_mesh_quantization",
};

std::string excerpt(const json& value)
{
    const std::string text = value.is_object() ? "an object" : value.is_array() ? "an array" : value.dump();
    return text.size() <= 40 ? text : text.substr(0, 40) + "...";
}

class JsonCheck {
public:
    JsonCheck(const std::string& path, const json& document) : m_path(path), m_document(document) {}

    void apply(const SchemaRule& rule) const { visit(rule, rule.path, m_document, ""); }

private:
    [[noreturn]] void refuseValue(const std::string& place, const json& value, const std::string& expected) const
    {
        throw InputError(m_path + ": " + (place.empty() ? "the document" : place) + " is " + excerpt(value) +
                         "; expected " + expected);
    }

    void visit(const SchemaRule& rule, std::string_view rest, const json& value, const std::string& place) const
    {
        if (rest.empty()) {
            checkValue(rule, value, place);
        } else if (rest.substr(0, 2) == "[]") {
            if (!value.is_array()) {
                refuseValue(place, value, "an array");
            }
            for (std::size_t i = 0; i < value.size(); ++i) {
                visit(rule, rest.substr(2), value[i], place + "[" + std::to_string(i) + "]");
            }
        } else if (rest.substr(0, 2) == "{}") {
            if (!value.is_object()) {
                refuseValue(place, value, "an object");
            }
            for (const auto& [key, member] : value.items()) {
                visit(rule, rest.substr(2), member, place + "." + key);
            }
        } else {
            visitMember(rule, rest.front() == '.' ? rest.substr(1) : rest, value, place);
        }
    }

    void visitMember(const SchemaRule& rule, std::string_view rest, const json& value, const std::string& place) const
    {
        const std::string name(rest.substr(0, rest.find_first_of(".[{")));
        rest.remove_prefix(name.size());
        const bool foreign = place.size() > 7 && place.compare(place.size() - 7, 7, ".extras") == 0;
        if (!value.is_object()) {
            if (foreign) {
                return;  // extras may hold anything
            }
            refuseValue(place, value, "an object");
        }
        const auto member = value.find(name);
        const std::string memberPlace = place.empty() ? name : place + "." + name;
        if (member != value.end()) {
            visit(rule, rest, *member, memberPlace);
        } else if (rest.empty() && rule.need == Need::Required) {
            throw InputError(m_path + ": " + memberPlace + " is missing; expected it to be given");
        }
    }

    void checkValue(const SchemaRule& rule, const json& value, const std::string& place) const
    {
        switch (rule.kind) {
        case JsonKind::Index: return checkIndex(rule, value, place);
        case JsonKind::Whole:
            if (!value.is_number_integer()) {
                refuseValue(place, value, "a whole number");
            }
            return checkNumber(rule, value, place);
        case JsonKind::Number: return checkNumber(rule, value, place);
        case JsonKind::Numbers:
            if (!value.is_array() || value.size() != rule.count) {
                refuseValue(place, value, "an array of " + std::to_string(rule.count) + " numbers");
            }
            for (std::size_t i = 0; i < value.size(); ++i) {
                checkNumber(rule, value[i], place + "[" + std::to_string(i) + "]");
            }
            return;
        case JsonKind::Bool: return checkType(value.is_boolean(), value, place, "true or false");
        case JsonKind::String: return checkType(value.is_string(), value, place, "a string");
        case JsonKind::Object: return checkType(value.is_object(), value, place, "an object");
        case JsonKind::Array: return checkType(value.is_array(), value, place, "an array");
        }
    }

    void checkType(bool right, const json& value, const std::string& place, const char* expected) const
    {
        if (!right) {
            refuseValue(place, value, expected);
        }
    }

    void checkNumber(const SchemaRule& rule, const json& value, const std::string& place) const
    {
        const bool inside = value.is_number() && value.get<double>() >= rule.min && value.get<double>() <= rule.max;
        if (inside) {
            return;
        }
        std::string expected = rule.kind == JsonKind::Whole ? "a whole number" : "a number";
        if (rule.min != -DBL_MAX) {
            expected += rule.min == kPositive ? " above 0" : " from " + toText(rule.min);
        }
        if (rule.max != DBL_MAX && rule.max != kMaxWhole) {
            expected += " to " + toText(rule.max);
        }
        refuseValue(place, value, expected);
    }

    void checkIndex(const SchemaRule& rule, const json& value, const std::string& place) const
    {
        const json* target = &m_document;
        for (std::string_view rest = rule.target; target != nullptr && !rest.empty();) {
            const std::string name(rest.substr(0, rest.find('.')));
            rest.remove_prefix(std::min(rest.size(), name.size() + 1));
            const auto member = target->find(name);
            target = member == target->end() ? nullptr : &*member;
        }
        const std::size_t size = target == nullptr ? 0 : target->size();
        if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= size) {
            refuseValue(place, value, "an index into " + std::string(rule.target) + ", which has " +
                                          std::to_string(size) + (size == 1 ? " entry" : " entries"));
        }
    }

    const std::string& m_path;
    const json& m_document;
};

void checkExtensions(const std::string& path, const json& document)
{
    for (const json& extension : document.value("extensionsRequired", json::array())) {
        if (!isSupportedExtension(extension.get<std::string>())) {
            std::string known;
            for (const char* name : kSupportedExtensions) {
                known += (known.empty() ? "" : ", ") + std::string(name);
            }
            throw InputError(path + ": extensionsRequired names " + extension.get<std::string>() +
                             "; expected only " + known);
        }
    }
}

}  // namespace

bool isSupportedExtension(const std::string& name)
{
    return std::find(std::begin(kSupportedExtensions), std::end(kSupportedExtensions), name) !=
           std::end(kSupportedExtensions);
}

void checkGltfJson(const std::string& path, const json& document)
{
    const JsonCheck check(path, document);
    for (const SchemaRule& rule : kSchemaRules) {
        check.apply(rule);
    }
    const json& asset = document.at("asset");
    const std::string version = asset.value("version", ""), minVersion = asset.value("minVersion", "2.0");
    if (version.rfind("2.", 0) != 0 || minVersion != "2.0") {
        throw InputError(path + ": asset asks for glTF " + (asset.contains("minVersion") ? minVersion : version) +
                         "; expected 2.0");
    }
    checkExtensions(path, document);
}

}  // namespace glim
