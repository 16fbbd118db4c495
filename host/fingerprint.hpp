#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glim {

// FNV-1a, 64 bits (Fowler, Noll, Vo): for what is compared with what glim itself has just made. Files have its values, so no faster hash of
// a library takes its place.
class Fingerprint {
public:
    explicit Fingerprint(std::uint64_t state = 14695981039346656037ULL)
        : state_(state)
    {}
    template <class T>
    void add(const std::vector<T>& values)
    {
        addBytes(std::as_bytes(std::span<const T>(values)));
    }
    void addBytes(std::span<const std::byte> bytes)
    {
        for (const std::byte byte : bytes) {
            state_ = (state_ ^ static_cast<std::uint64_t>(byte)) * 1099511628211ULL;
        }
    }
    std::uint64_t state() const { return state_; }

private:
    std::uint64_t state_;
};

}  // namespace glim
