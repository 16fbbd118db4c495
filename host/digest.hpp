#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glim {

// SHA-256 (FIPS 180-4), by OpenSSL: for what a file says of itself, since two films that differ never have the same.
class Digest {
public:
    Digest();
    ~Digest();
    Digest(const Digest&) = delete;
    Digest& operator=(const Digest&) = delete;

    void add(std::span<const std::byte> bytes);
    // With its length before it: no two sequences of texts have the same bytes.
    void add(const std::string& text);
    template <class T>
    void add(const std::vector<T>& values)
    {
        add(std::as_bytes(std::span<const T>(values)));
    }
    // 64 hexadecimal digits. To be called once.
    std::string finish();

private:
    struct Context;
    std::unique_ptr<Context> context_;
};

}  // namespace glim
