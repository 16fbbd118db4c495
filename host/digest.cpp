#include "host/digest.hpp"

#include <openssl/evp.h>

#include <array>
#include <cstdint>

namespace glim {

struct Digest::Context {
    EVP_MD_CTX* state = EVP_MD_CTX_new();
    ~Context() { EVP_MD_CTX_free(state); }
};

Digest::Digest()
    : context_(std::make_unique<Context>())
{
    EVP_DigestInit_ex(context_->state, EVP_sha256(), nullptr);
}

Digest::~Digest() = default;

void Digest::add(std::span<const std::byte> bytes) { EVP_DigestUpdate(context_->state, bytes.data(), bytes.size()); }

void Digest::add(const std::string& text)
{
    add(std::vector<std::uint64_t>{text.size()});
    add(std::as_bytes(std::span(text)));
}

std::string Digest::finish()
{
    std::array<unsigned char, 32> bytes{};
    EVP_DigestFinal_ex(context_->state, bytes.data(), nullptr);
    std::string digits;
    for (const unsigned byte : bytes) {
        digits += {"0123456789abcdef"[byte >> 4U], "0123456789abcdef"[byte & 15U]};
    }
    return digits;
}

}  // namespace glim
