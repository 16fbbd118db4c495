#include "host/image/cryptomatte.hpp"

#include "host/json.hpp"

#include <algorithm>
#include <bit>
#include <cstdio>

namespace glim {
namespace {

std::string hexadecimal(std::uint32_t value)
{
    char text[9];
    std::snprintf(text, sizeof text, "%08x", value);
    return text;
}

std::string matteChannel(const std::string& layer, std::size_t rank, const char* letters)
{
    return layer + "0" + std::to_string(rank / 2) + "." + letters[rank % 2];
}

// What a word of the text becomes before it is mixed in.
std::uint32_t scramble(std::uint32_t word) { return std::rotl(word * 0xcc9e2d51U, 15) * 0x1b873593U; }

}  // namespace

std::uint32_t murmurHash3(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return std::uint32_t{static_cast<unsigned char>(text[i])}; };
    const std::size_t whole = text.size() / 4 * 4;
    std::uint32_t hash = 0;
    for (std::size_t i = 0; i < whole; i += 4) {
        hash ^= scramble(byte(i) | byte(i + 1) << 8U | byte(i + 2) << 16U | byte(i + 3) << 24U);
        hash = std::rotl(hash, 13) * 5 + 0xe6546b64U;
    }
    std::uint32_t tail = 0;
    for (std::size_t i = text.size(); i > whole; --i) {
        tail = tail << 8U | byte(i - 1);
    }
    hash ^= scramble(tail);
    hash ^= static_cast<std::uint32_t>(text.size());
    hash = (hash ^ hash >> 16U) * 0x85ebca6bU;
    hash = (hash ^ hash >> 13U) * 0xc2b2ae35U;
    return hash ^ hash >> 16U;
}

std::uint32_t matteId(std::string_view name)
{
    constexpr std::uint32_t kExponent = 0xffU << 23U;
    const std::uint32_t hash = murmurHash3(name);
    const std::uint32_t exponent = std::clamp(hash >> 23U & 0xffU, 1U, 254U);
    return (hash & ~kExponent) | exponent << 23U;
}

std::string matteIdChannel(const std::string& layer, std::size_t rank) { return matteChannel(layer, rank, "RB"); }

std::string matteCoverageChannel(const std::string& layer, std::size_t rank) { return matteChannel(layer, rank, "GA"); }

void addMatteAttributes(Image& image, const std::string& layer, const std::map<std::string, std::uint32_t>& manifest)
{
    std::string json = "{";
    for (const auto& [name, id] : manifest) {
        json += (json.size() == 1 ? "" : ",") + Json(name).dump() + ":\"" + hexadecimal(id) + "\"";
    }
    const std::string key = "cryptomatte/" + hexadecimal(murmurHash3(layer)).substr(0, 7) + "/";
    image.attributes[key + "name"] = layer;
    image.attributes[key + "hash"] = "MurmurHash3_32";
    image.attributes[key + "conversion"] = "uint32_to_float32";
    image.attributes[key + "manifest"] = json + "}";
}

}  // namespace glim
