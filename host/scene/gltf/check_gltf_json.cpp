#include "host/scene/gltf/check_gltf_json.hpp"

#include "host/error.hpp"
#include "host/message.hpp"
#include "host/scene/gltf/extensions.hpp"
#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/gltf/gltf_schema.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace glim {
namespace {

using nlohmann::json;

std::string excerpt(const json& value) { return shortened(value.is_object() ? "an object" : value.is_array() ? "an array" : value.dump()); }

std::string describeRange(const SchemaRule& rule)
{
    std::string range;
    if (rule.min != -DBL_MAX) {
        range += rule.min == kPositive ? " above 0" : " from " + toText(rule.min);
    }
    if (rule.max != DBL_MAX && rule.max != kMaxWhole) {
        range += " to " + (rule.kind == JsonKind::Whole ? std::to_string(static_cast<std::int64_t>(rule.max)) : toText(rule.max));
    }
    return range;
}

bool isInRange(const SchemaRule& rule, const json& value)
{
    return value.is_number() && value.get<double>() >= rule.min && value.get<double>() <= rule.max;
}

// Whether a number is out of the rule's range by no more than rounding.
bool isRoundedOut(const SchemaRule& rule, const json& value)
{
    if (!value.is_number() || isInRange(rule, value)) {
        return false;
    }
    const double number = value.get<double>();
    return number > rule.max ? number - rule.max <= rule.rounding : rule.min != kPositive && rule.min - number <= rule.rounding;
}

// JSON has one kind of number: 4.0 is 4, and -0 is 0.
void makeWhole(json& value)
{
    const double number = value.is_number() ? value.get<double>() : 0.5;
    if (!value.is_number_unsigned() && std::abs(number) <= kMaxWhole && number == std::floor(number)) {
        number < 0.0 ? value = static_cast<std::int64_t>(number) : value = static_cast<std::uint64_t>(number);
    }
}

bool isOneOf(const std::string& words, const json& value)
{
    return value.is_string() && (", " + words + ",").find(", " + value.get<std::string>() + ",") != std::string::npos;
}

// Where a value is in the document. It is written out in messages alone: a document may have millions of values.
struct Place {
    const Place* parent = nullptr;  // none: the document
    std::string_view name;          // of a member
    std::optional<std::size_t> index;

    std::string text() const
    {
        if (parent == nullptr) {
            return "";
        }
        const std::string before = parent->text();
        return index ? before + "[" + std::to_string(*index) + "]" : (before.empty() ? "" : before + ".") + shortened(std::string(name));
    }
};

// What holds for the values at one path, and at the paths that begin with it. So the work of a check grows with the document, and not with
// its elements times the rules for them.
struct RuleNode {
    std::string name;  // of a member
    std::vector<SchemaRule> rules;
    std::vector<std::unique_ptr<RuleNode>> members;  // in the order of the rules
    std::unique_ptr<RuleNode> elements, values;      // `[]`, `{}`

    RuleNode& memberOf(std::string_view wanted)
    {
        for (const std::unique_ptr<RuleNode>& member : members) {
            if (member->name == wanted) {
                return *member;
            }
        }
        RuleNode& made = *members.emplace_back(std::make_unique<RuleNode>());
        made.name = wanted;
        return made;
    }

    // `rest`: what is left of the rule's path.
    void add(const SchemaRule& rule, std::string_view rest)
    {
        if (rest.empty()) {
            rules.push_back(rule);
        } else if (rest.substr(0, 2) == "[]" || rest.substr(0, 2) == "{}") {
            std::unique_ptr<RuleNode>& all = rest.front() == '[' ? elements : values;
            all = all ? std::move(all) : std::make_unique<RuleNode>();
            all->add(rule, rest.substr(2));
        } else {
            rest.remove_prefix(rest.front() == '.' ? 1 : 0);
            const std::string_view member = rest.substr(0, rest.find_first_of(".[{"));
            memberOf(member).add(rule, rest.substr(member.size()));
        }
    }
    void add(const std::string& place, std::span<const SchemaRule> more)
    {
        for (const SchemaRule& rule : more) {
            add(rule, place + rule.path);
        }
    }
};

RuleNode makeRules()
{
    RuleNode rules;
    rules.add("", kSchemaRules);
    for (const std::string_view slot : kTexturePaths) {
        rules.add("materials[]." + std::string(slot), kTextureRules);
    }
    for (const std::string name : kMeshoptExtensions) {
        rules.add("buffers[].extensions." + name, kMeshoptBufferRules);
        rules.add("bufferViews[].extensions." + name, kMeshoptViewRules);
    }
    return rules;
}

// Checks a document by the rules, and mends what is right but for its rounding or its spelling.
class JsonCheck {
public:
    JsonCheck(const std::string& path, json& document, Warnings& warnings)
        : path_(path),
          document_(document),
          warnings_(warnings)
    {}

    void apply(const RuleNode& rules) const { visit(rules, document_, Place()); }

private:
    void require(bool right, const Place& place, const json& value, const SchemaRule& rule) const
    {
        if (!right) {
            refuse(idOf(rule, value), place, value, describe(rule));
        }
    }

    [[noreturn]] void refuse(MessageId id, const Place& place, const json& value, const std::string& expected) const
    {
        throw InputError(id, {part::file(path_), ": ", part::place(place.parent == nullptr ? "the document" : place.text()), " is ",
                              part::value(excerpt(value)), "; expected ", part::expected(expected)});
    }

    static MessageId idOf(const SchemaRule& rule, const json& value)
    {
        switch (rule.kind) {
        case JsonKind::Index: return value.is_number() ? MessageId::DanglingIndex : MessageId::WrongType;
        case JsonKind::Whole:
        case JsonKind::Number: return value.is_number() ? MessageId::OutOfRange : MessageId::WrongType;
        case JsonKind::Numbers: return value.is_array() ? MessageId::Mismatch : MessageId::WrongType;
        case JsonKind::OneOf: return value.is_string() ? MessageId::UnknownName : MessageId::WrongType;
        default: return MessageId::WrongType;
        }
    }

    void visit(const RuleNode& node, json& value, const Place& place) const
    {
        for (const SchemaRule& rule : node.rules) {
            checkValue(rule, value, place);
        }
        if (node.elements && !value.is_array()) {
            refuse(MessageId::WrongType, place, value, "an array");
        }
        for (std::size_t i = 0; node.elements && i < value.size(); ++i) {
            visit(*node.elements, value[i], {&place, "", i});
        }
        const bool isExtras = place.name == "extras";  // which may hold anything
        if ((node.values || (!node.members.empty() && !isExtras)) && !value.is_object()) {
            refuse(MessageId::WrongType, place, value, "an object");
        }
        if (node.values) {
            for (auto& [key, member] : value.items()) {
                visit(*node.values, member, {&place, key, {}});
            }
        }
        for (std::size_t i = 0; i < node.members.size() && value.is_object(); ++i) {
            visitMember(*node.members[i], value, {&place, node.members[i]->name, {}});
        }
    }

    void visitMember(const RuleNode& node, json& value, const Place& place) const
    {
        const auto member = value.find(place.name);
        if (member == value.end()) {
            for (const SchemaRule& rule : node.rules) {
                if (rule.need == Need::Required) {
                    throw InputError(MessageId::Missing, {part::file(path_), ": ", part::place(place.text()), " is missing; expected ",
                                                          part::expected(describe(rule))});
                }
            }
        } else if (isNone(node, *member)) {
            warnings_.add(MessageId::ZeroIgnored, "zeros count as left out where glTF has no meaning for 0", place.text());
            value.erase(member);
        } else {
            visit(node, *member, place);
        }
    }

    static bool isNone(const RuleNode& node, const json& value)
    {
        return value.is_number() && value.get<double>() == 0.0 &&
               std::any_of(node.rules.begin(), node.rules.end(), [](const SchemaRule& rule) { return rule.zeroIsNone; });
    }

    void checkValue(const SchemaRule& rule, json& value, const Place& place) const
    {
        if (rule.kind == JsonKind::Index || rule.kind == JsonKind::Whole) {
            makeWhole(value);
        } else if (rule.kind == JsonKind::Number) {
            clampRounded(rule, value, place);
        }
        require(isRight(rule, value), place, value, rule);
        for (std::size_t i = 0; rule.kind == JsonKind::Numbers && i < value.size(); ++i) {
            const Place element{&place, "", i};
            clampRounded(rule, value[i], element);
            if (!isInRange(rule, value[i])) {
                refuse(value[i].is_number() ? MessageId::OutOfRange : MessageId::WrongType, element, value[i],
                       "a number" + describeRange(rule));
            }
        }
    }

    void clampRounded(const SchemaRule& rule, json& value, const Place& place) const
    {
        if (isRoundedOut(rule, value)) {
            warnings_.add(MessageId::NumberClamped, kClamped, place.text() + " " + excerpt(value));
            value = std::clamp(value.get<double>(), rule.min, rule.max);
        }
    }

    bool isRight(const SchemaRule& rule, const json& value) const
    {
        switch (rule.kind) {
        case JsonKind::Index: return value.is_number_unsigned() && value.get<std::uint64_t>() < computeSize(rule.target);
        case JsonKind::Whole: return value.is_number_integer() && isInRange(rule, value);
        case JsonKind::Number: return isInRange(rule, value);
        case JsonKind::Numbers: return value.is_array() && value.size() == rule.count;
        case JsonKind::Bool: return value.is_boolean();
        case JsonKind::String: return value.is_string();
        case JsonKind::OneOf: return isOneOf(rule.target, value);
        case JsonKind::Object: return value.is_object();
        case JsonKind::Array: return value.is_array();
        }
        return false;
    }

    std::string describe(const SchemaRule& rule) const
    {
        switch (rule.kind) {
        case JsonKind::Index: {
            const std::size_t size = computeSize(rule.target);
            return "an index into " + std::string(rule.target) + ", which has " + std::to_string(size) +
                   (size == 1 ? " entry" : " entries");
        }
        case JsonKind::Whole: return "a whole number" + describeRange(rule);
        case JsonKind::Number: return "a number" + describeRange(rule);
        case JsonKind::Numbers: return "an array of " + std::to_string(rule.count) + " numbers";
        case JsonKind::Bool: return "true or false";
        case JsonKind::String: return "a string";
        case JsonKind::OneOf: return "one of " + std::string(rule.target);
        case JsonKind::Object: return "an object";
        case JsonKind::Array: return "an array";
        }
        return "";
    }

    // The size of the array at a dotted path; 0 if there is none.
    std::size_t computeSize(std::string_view target) const
    {
        const json* at = &document_;
        while (!target.empty()) {
            const std::string_view name = target.substr(0, target.find('.'));
            target.remove_prefix(std::min(target.size(), name.size() + 1));
            const auto member = at->find(name);
            if (member == at->end()) {
                return 0;
            }
            at = &*member;
        }
        return at->is_array() ? at->size() : 0;
    }

    const std::string& path_;
    json& document_;
    Warnings& warnings_;
};

// Erases members that are null, but for those in extras.
void eraseNulls(json& value, const Place& place, Warnings& warnings)
{
    if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i) {
            if (value[i].is_structured()) {
                eraseNulls(value[i], {&place, "", i}, warnings);
            }
        }
        return;
    }
    for (auto member = value.begin(); member != value.end();) {
        const Place at{&place, member.key(), {}};
        const bool isNull = member->is_null();
        if (isNull) {
            warnings.add(MessageId::NullIgnored, "members that are null count as left out", at.text());
        } else if (member->is_structured() && member.key() != "extras") {
            eraseNulls(*member, at, warnings);
        }
        member = isNull ? value.erase(member) : std::next(member);
    }
}

// Rounds last rows of matrices of nodes.
void makeAffine(json& document, Warnings& warnings)
{
    json none = json::array();
    json& nodes = document.contains("nodes") ? document["nodes"] : none;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto matrix = nodes[i].find("matrix");
        if (matrix == nodes[i].end()) {
            continue;
        }
        double error = 0.0;
        for (std::size_t column = 0; column < 4; ++column) {
            error = std::max(error, std::abs((*matrix)[4 * column + 3].get<double>() - (column == 3 ? 1.0 : 0.0)));
        }
        if (error > 0.0 && error <= kAffineRounding) {
            for (std::size_t column = 0; column < 4; ++column) {
                (*matrix)[4 * column + 3] = column == 3 ? 1.0 : 0.0;
            }
            warnings.add(MessageId::MatrixRounded, "last rows of matrices are rounded to 0 0 0 1", "nodes[" + std::to_string(i) + "]");
        }
    }
}

// glTF 1.0 has objects where 2.0 has arrays, and need not have an asset.
bool isFirstVersion(const json& document)
{
    const json asset = document.value("asset", json::object());
    const json version = asset.is_object() && asset.contains("version") ? asset["version"] : json();
    if (version.is_string() || version.is_number()) {
        return (version.is_string() ? version.get<std::string>() : version.dump()).rfind("1.", 0) == 0 || version == 1;
    }
    return std::ranges::any_of(std::array{"accessors", "bufferViews", "buffers", "meshes", "nodes", "scenes"},
                               [&](const char* name) { return document.contains(name) && document[name].is_object(); });
}

void checkVersion(const std::string& path, const json& asset, Warnings& warnings)
{
    const std::string version = asset.value("version", ""), minVersion = asset.value("minVersion", "2.0");
    if (version.rfind("2.", 0) != 0 || minVersion != "2.0") {
        throw InputError(MessageId::UnknownFormat, {part::file(path), ": ", part::place("asset"), " asks for glTF ",
                                                    part::value(shortened(asset.contains("minVersion") ? minVersion : version)),
                                                    "; expected ", part::expected("2.0")});
    }
    if (version != "2.0") {
        warnings.add(
            {MessageId::LaterVersion,
             {part::place("asset.version"), " is ", part::value(shortened(version)), ": it is read as glTF 2.0, without what is new"}});
    }
}

void checkExtensions(const std::string& path, const json& document)
{
    for (const json& extension : document.value("extensionsRequired", json::array())) {
        if (getEffect(extension.get<std::string>()) == ExtensionEffect::Content) {
            throw InputError(
                MessageId::Unsupported,
                {part::file(path), ": ", part::place("extensionsRequired"), " names ", part::value(shortened(extension.get<std::string>())),
                 ", without which geometry or images may be missing; expected ", part::expected("a file that does not need it")});
        }
    }
}

// Elements of `collection` have an object of the name that `getName` gives, unless it is empty.
template <class NameOf>
void checkParts(const std::string& path, const json& document, const json::json_pointer& collection, const NameOf& getName)
{
    const json elements = document.value(collection, json::array());
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const std::string type = elements[i]["type"].get<std::string>(), name = getName(type);
        if (!name.empty() && !elements[i].contains(name)) {
            std::string place = collection.to_string().substr(1);
            std::replace(place.begin(), place.end(), '/', '.');
            throw InputError(MessageId::Missing, {part::file(path), ": ", part::place(place + "[" + std::to_string(i) + "]." + name),
                                                  " is missing; expected ", part::expected("an object, as its type is " + type)});
        }
    }
}

}  // namespace

const SchemaRule* findRule(const std::string& path)
{
    for (const SchemaRule& rule : kSchemaRules) {
        if (path == rule.path) {
            return &rule;
        }
    }
    for (const std::string_view slot : kTexturePaths) {
        for (const SchemaRule& rule : kTextureRules) {
            if (path == "materials[]." + std::string(slot) + rule.path) {
                return &rule;
            }
        }
    }
    return nullptr;
}

void checkGltfJson(const std::string& path, json& document, Warnings& warnings)
{
    if (document.is_object() && isFirstVersion(document)) {
        throw InputError(MessageId::UnknownFormat, {part::file(path), ": is ", part::value("glTF 1.0"), "; expected ",
                                                    part::expected("glTF 2.0, which converters for old files make of it")});
    }
    if (document.is_object()) {
        eraseNulls(document, Place(), warnings);
    }
    static const RuleNode kRules = makeRules();
    JsonCheck(path, document, warnings).apply(kRules);
    makeAffine(document, warnings);
    checkParts(path, document, json::json_pointer("/cameras"), [](const std::string& type) { return type; });
    checkParts(path, document, json::json_pointer("/extensions/KHR_lights_punctual/lights"),
               [](const std::string& type) { return std::string(type == "spot" ? "spot" : ""); });
    checkVersion(path, document.at("asset"), warnings);
    checkExtensions(path, document);
}

}  // namespace glim
