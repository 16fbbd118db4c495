// Mutants of glTF that get past the JSON parser and the container: most change the tree of values, some the bytes.
#include "host/scene/gltf/gltf_schema.hpp"
#include "tests/fuzz/mutator.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <string>

namespace glim::fuzz {
namespace {

using nlohmann::json;

struct Document {
    bool isGlb = false;
    std::string text, binary;
};

std::uint32_t u32(const std::string& bytes, std::size_t at)
{
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) {
        value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << 8U * i;
    }
    return value;
}

std::string bytesOf(std::size_t value)
{
    std::string bytes;
    for (unsigned i = 0; i < 4; ++i) {
        bytes += static_cast<char>(value >> 8U * i & 255U);
    }
    return bytes;
}

// A damaged container counts as text.
Document parse(const std::string& bytes)
{
    constexpr std::size_t kHeader = 12, kChunkHeader = 8;
    if (bytes.size() < kHeader + kChunkHeader || bytes.rfind("glTF", 0) != 0) {
        return {false, bytes, ""};
    }
    const std::size_t text = kHeader + kChunkHeader, textSize = std::min<std::size_t>(u32(bytes, kHeader), bytes.size() - text);
    const std::size_t binary = text + textSize + kChunkHeader;
    return {true, bytes.substr(text, textSize), binary < bytes.size() ? bytes.substr(binary) : ""};
}

std::string write(const Document& document)
{
    if (!document.isGlb) {
        return document.text;
    }
    std::string text = document.text;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::string chunks =
        bytesOf(text.size()) + "JSON" + text + bytesOf(document.binary.size()) + std::string("BIN\0", 4) + document.binary;
    return "glTF" + bytesOf(2) + bytesOf(12 + chunks.size()) + chunks;
}

bool isDeep(const std::string& text)
{
    int depth = 0, deepest = 0;
    for (const char c : text) {
        depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
        deepest = std::max(deepest, depth);
    }
    return deepest > 200;
}

// Discarded where the text is no JSON, or one of which recursion would run out of stack.
json parseTree(const std::string& text) { return isDeep(text) ? json(json::value_t::discarded) : json::parse(text, nullptr, false); }

const double kNumbers[] = {0,
                           -1,
                           1,
                           2,
                           0.5,
                           3,
                           4,
                           255,
                           256,
                           65535,
                           65536,
                           1e39,
                           1e-39,
                           1e-320,
                           1e308,
                           -1e308,
                           3.4e38,
                           1e-7,
                           1e7,
                           1e20,
                           2147483647,
                           2147483648,
                           5120,
                           5121,
                           5123,
                           5125,
                           5126,
                           4294967295,
                           4294967296,
                           9007199254740992,
                           9007199254740994,
                           1.8446744073709552e19};

class TreeMutator {
public:
    TreeMutator(Choice& choice, json& root)
        : choice_(choice),
          root_(root)
    {}

    void mutate()
    {
        switch (choice_.below(9)) {
        case 0: *pick() = anyNumber(); break;
        case 1: nudge(*pick()); break;
        case 2: std::swap(*pickLeaf(), *pickLeaf()); break;
        case 3: splice(json(*pick())); break;
        case 4: remove(); break;
        case 5: duplicate(); break;
        case 6: retype(*pick()); break;
        case 7: changeText(*pickLeaf()); break;
        default: applyRule();
        }
    }

    // Puts a value in the place of another.
    void splice(const json& value)
    {
        json* place = pick();
        if (place != &root_) {
            *place = value;
        }
    }

    // A value, reached by descending from the root: each level is as likely, however many numbers a matrix has.
    json* pick() { return descend(4); }

private:
    json* pickLeaf() { return descend(1000); }

    json* descend(std::size_t stopOneIn)
    {
        json* value = &root_;
        while (value->is_structured() && !value->empty() && (value == &root_ || stopOneIn > 100 || !choice_.oneIn(stopOneIn))) {
            value = &*std::next(value->begin(), static_cast<std::ptrdiff_t>(choice_.below(value->size())));
        }
        return value;
    }

    json anyNumber()
    {
        const double number = choice_.of(kNumbers);
        const bool whole = number >= 0 && number < 1.8e19 && number == std::floor(number) && !choice_.oneIn(4);
        return whole ? json(static_cast<std::uint64_t>(number)) : json(number);
    }

    void nudge(json& value)
    {
        if (value.is_number_integer()) {
            value = value.get<std::int64_t>() / 2 + static_cast<std::int64_t>(choice_.below(5)) - 2 + value.get<std::int64_t>() / 2;
        } else if (value.is_number_float()) {
            const double factors[] = {-1, 2, 0.5, 1e10, 1e-10, 1.0000001};
            value = value.get<double>() * choice_.of(factors);
        } else {
            value = anyNumber();
        }
    }

    json* pickParent()
    {
        json* value = &root_;
        for (json* next = value; next->is_structured() && !next->empty() && (value == &root_ || !choice_.oneIn(4));) {
            value = next;
            next = &*std::next(value->begin(), static_cast<std::ptrdiff_t>(choice_.below(value->size())));
        }
        return value;
    }

    void remove()
    {
        json* parent = pickParent();
        if (parent->is_structured() && !parent->empty()) {
            parent->erase(std::next(parent->begin(), static_cast<std::ptrdiff_t>(choice_.below(parent->size()))));
        }
    }

    void duplicate()
    {
        json* parent = pickParent();
        if (parent->is_array() && !parent->empty()) {
            const std::size_t times = choice_.oneIn(8) ? 20 : 1;
            const json element = (*parent)[choice_.below(parent->size())];
            parent->insert(parent->end(), times, element);
        } else if (parent->is_object()) {
            (*parent)[lastWord(choice_.of(kSchemaRules).path)] = json(*pick());
        }
    }

    static std::string lastWord(const std::string& path)
    {
        const std::string name = path.substr(path.rfind('.') + 1);
        return name.substr(0, name.find_first_of("[{"));
    }

    void retype(json& value)
    {
        const json values[] = {nullptr, true, false, "", "x", json::array(), json::object(), 0, 1.5, json::array({0, 1, 2})};
        if (&value != &root_) {
            value = choice_.of(values);
        }
    }

    void changeText(json& value)
    {
        if (value.is_string()) {
            mutateBytes(value.get_ref<std::string&>(), 16);
        } else {
            nudge(value);
        }
    }

    // Gives a place that the schema knows a value that fits, or almost.
    void applyRule()
    {
        if (choice_.oneIn(4)) {
            const SchemaRule& rule = choice_.of(kTextureRules);
            apply("materials[]." + std::string(choice_.of(kTexturePaths)) + rule.path, rule);
            return;
        }
        const SchemaRule& rule = choice_.of(kSchemaRules);
        apply(rule.path, rule);
    }

    void apply(const std::string& path, const SchemaRule& rule)
    {
        json* at = &root_;
        std::istringstream words(path);
        for (std::string word; std::getline(words, word, '.');) {
            const std::string name = word.substr(0, word.find_first_of("[{"));
            if (!at->is_object()) {
                *at = json::object();
            }
            at = &(*at)[name];
            for (std::size_t i = name.size(); i < word.size(); i += 2) {
                at = word[i] == '[' ? anyElement(*at) : anyMember(*at);
            }
        }
        *at = fitting(rule);
    }

    json* anyElement(json& array)
    {
        if (!array.is_array()) {
            array = json::array();
        }
        if (array.empty() || choice_.oneIn(8)) {
            array.push_back(nullptr);
        }
        return &array[choice_.below(array.size())];
    }

    json* anyMember(json& object)
    {
        if (!object.is_object() || object.empty()) {
            object = {{"POSITION", 0}};
        }
        return &*std::next(object.begin(), static_cast<std::ptrdiff_t>(choice_.below(object.size())));
    }

    json fitting(const SchemaRule& rule)
    {
        switch (rule.kind) {
        case JsonKind::Index: return choice_.below(4);
        case JsonKind::Whole: return anyNumber();
        case JsonKind::Number: return choice_.oneIn(2) ? anyNumber() : json(0.25 * static_cast<double>(choice_.below(9)));
        case JsonKind::Bool: return choice_.oneIn(2);
        case JsonKind::String: return "scene.gltf";
        case JsonKind::Object: return json::object();
        case JsonKind::Array: return json::array();
        case JsonKind::OneOf: return anyWord(rule.target);
        case JsonKind::Numbers: break;
        }
        json numbers = json::array();
        for (std::size_t i = 0; i < rule.count; ++i) {
            numbers.push_back(choice_.oneIn(8) ? anyNumber() : json(0.25 * static_cast<double>(choice_.below(5))));
        }
        return numbers;
    }

    std::string anyWord(const std::string& list)
    {
        std::istringstream stream(list);
        std::vector<std::string> words;
        for (std::string word; stream >> word;) {
            words.push_back(word.substr(0, word.find(',')));
        }
        return choice_.of(words);
    }

    Choice& choice_;
    json& root_;
};

void mutateText(Document& document, Choice& choice)
{
    json tree = parseTree(document.text);
    if (tree.is_discarded() || choice.oneIn(20)) {
        mutateBytes(document.text, 64);
        return;
    }
    for (std::size_t edits = 1 + choice.below(3); edits > 0; --edits) {
        TreeMutator(choice, tree).mutate();
    }
    document.text = tree.dump(-1, ' ', false, json::error_handler_t::replace);
}

// Where the document says that parts of the binary chunk are: views, and what stands compressed for one.
std::vector<std::pair<std::size_t, std::size_t>> listRanges(const json& document)
{
    std::vector<std::pair<std::size_t, std::size_t>> ranges;
    const auto add = [&ranges](const json& view) {
        const json offset = view.is_object() ? view.value("byteOffset", json(0U)) : json();
        const json length = view.is_object() ? view.value("byteLength", json()) : json();
        if (offset.is_number_unsigned() && length.is_number_unsigned()) {
            ranges.emplace_back(offset.get<std::size_t>(), length.get<std::size_t>());
        }
    };
    const json views = document.is_object() ? document.value("bufferViews", json()) : json();
    for (const json& view : views) {
        add(view);
        const json extensions = view.is_object() ? view.value("extensions", json()) : json();
        for (const json& extension : extensions) {
            add(extension);
        }
    }
    return ranges;
}

// Most mutants change the bytes of one view and move no others, so that what is compressed elsewhere stays right.
void mutateBinary(Document& document, Choice& choice)
{
    const std::vector<std::pair<std::size_t, std::size_t>> ranges = listRanges(parseTree(document.text));
    const auto [offset, length] = ranges.empty() ? std::pair(std::size_t{0}, std::size_t{0}) : choice.of(ranges);
    if (offset >= document.binary.size() || length == 0 || choice.oneIn(8)) {
        mutateBytes(document.binary, 64);
        return;
    }
    std::string part = document.binary.substr(offset, length);
    const std::size_t size = part.size();
    mutateBytes(part, 0);
    part.resize(size);
    document.binary.replace(offset, size, part);
}

std::string mutateInput(const std::string& input, Choice& choice)
{
    Document document = parse(input);
    if (!document.binary.empty() && choice.oneIn(3)) {
        mutateBinary(document, choice);
    } else {
        mutateText(document, choice);
    }
    document.isGlb = document.isGlb != choice.oneIn(50);
    std::string mutant = write(document);
    if (choice.oneIn(20)) {
        mutateBytes(mutant, 16);
    }
    return mutant;
}

std::string toString(const std::uint8_t* data, std::size_t size) { return {reinterpret_cast<const char*>(data), size}; }

}  // namespace
}  // namespace glim::fuzz

using namespace glim::fuzz;

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed)
{
    Choice choice(seed);
    return handOver(mutateInput(toString(data, size), choice), data, size, room);
}

// A subtree of one input replaces one of the other.
extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* a, std::size_t sizeOfA, const std::uint8_t* b, std::size_t sizeOfB,
                                                 std::uint8_t* out, std::size_t room, unsigned seed)
{
    Choice choice(seed);
    Document document = parse(toString(a, sizeOfA));
    json tree = parseTree(document.text), other = parseTree(parse(toString(b, sizeOfB)).text);
    if (!tree.is_discarded() && !other.is_discarded()) {
        TreeMutator(choice, tree).splice(*TreeMutator(choice, other).pick());
        document.text = tree.dump(-1, ' ', false, json::error_handler_t::replace);
    }
    const std::string mutant = write(document);
    std::copy_n(mutant.begin(), std::min(mutant.size(), room), out);
    return std::min(mutant.size(), room);
}
