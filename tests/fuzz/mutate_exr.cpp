#include "tests/fuzz/mutate_exr.hpp"

#include <cstring>
#include <optional>
#include <utility>

namespace glim::fuzz {
namespace {

// openexr.com/en/latest/OpenEXRFileLayout.html
struct Attribute {
    std::string name, type, value;
};

struct ExrFile {
    std::string start;  // magic number and version
    std::vector<Attribute> attributes;
    std::vector<std::uint64_t> offsets;  // of the blocks of rows, from the end of the table
    std::string blocks;
};

template <class Number>
Number numberAt(const std::string& bytes, std::size_t at)
{
    Number number{};
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
}

template <class Number>
void append(std::string& bytes, Number number)
{
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::optional<ExrFile> parse(const std::string& bytes)
{
    ExrFile file;
    std::size_t at = 8;
    const auto readWord = [&](std::string& word) {
        const std::size_t end = bytes.find('\0', at);
        word = bytes.substr(std::min(at, bytes.size()), end - at);
        at = end == std::string::npos ? end : end + 1;
        return at <= bytes.size();
    };
    file.start = bytes.substr(0, at);
    for (Attribute attribute; readWord(attribute.name) && !attribute.name.empty();) {
        if (!readWord(attribute.type) || bytes.size() - at < 4) {
            return std::nullopt;
        }
        const auto size = numberAt<std::uint32_t>(bytes, at);
        if (bytes.size() - at - 4 < size) {
            return std::nullopt;
        }
        attribute.value = bytes.substr(at + 4, size);
        at += 4 + size;
        file.attributes.push_back(attribute);
    }
    if (at > bytes.size() || bytes.size() - at < 8) {
        return std::nullopt;
    }
    // The first block follows the table.
    const auto first = numberAt<std::uint64_t>(bytes, at);
    if (first < at + 8 || first > bytes.size()) {
        return std::nullopt;
    }
    for (; at + 8 <= first; at += 8) {
        file.offsets.push_back(numberAt<std::uint64_t>(bytes, at) - first);
    }
    file.blocks = bytes.substr(first);
    return file;
}

std::string write(const ExrFile& file)
{
    std::string bytes = file.start;
    for (const Attribute& attribute : file.attributes) {
        bytes += attribute.name + '\0' + attribute.type + '\0';
        append(bytes, static_cast<std::uint32_t>(attribute.value.size()));
        bytes += attribute.value;
    }
    bytes += '\0';
    const std::size_t first = bytes.size() + 8 * file.offsets.size();
    for (const std::uint64_t offset : file.offsets) {
        append(bytes, offset + first);
    }
    return bytes + file.blocks;
}

void mutateAttributes(std::vector<Attribute>& attributes, Choice& choice)
{
    const std::int32_t numbers[] = {0, 1, -1, 2, 7, 16, 255, 1024, 65536, 1 << 20, -1000000, 2147483647, -2147483647 - 1};
    if (attributes.empty()) {
        return;
    }
    Attribute& one = choice.of(attributes);
    switch (choice.below(8)) {
    case 0: std::swap(one.value, choice.of(attributes).value); break;
    case 1: one = choice.of(attributes); break;
    case 2: attributes.erase(attributes.begin() + static_cast<std::ptrdiff_t>(choice.below(attributes.size()))); break;
    case 3: mutateBytes(one.name, 4); break;
    case 4: one.type = choice.of(attributes).type; break;
    case 5:
    case 6:
        if (one.value.size() >= 4) {
            const std::int32_t number = choice.of(numbers);
            std::memcpy(&one.value[4 * choice.below(one.value.size() / 4)], &number, sizeof number);
            break;
        }
        [[fallthrough]];
    default: mutateBytes(one.value, 8);
    }
    for (Attribute& attribute : attributes) {
        attribute.name.erase(std::min(attribute.name.find('\0'), attribute.name.size()));
    }
}

}  // namespace

void mutateExr(std::string& bytes, Choice& choice)
{
    std::optional<ExrFile> file = parse(bytes);
    if (!file || choice.oneIn(20)) {
        mutateBytes(bytes, 64);
        return;
    }
    if (choice.oneIn(4)) {
        mutateBytes(file->blocks, 16);
    } else {
        mutateAttributes(file->attributes, choice);
    }
    bytes = write(*file);
}

}  // namespace glim::fuzz
