// A storage buffer that notices writes beyond its end.
#pragma once

#include "host/gpu/buffer.hpp"

#include <optional>

namespace glim {

// Behind its content is a guard, which kernels can write: of kSentinel, as large as 64 bytes for each thread of a workgroup. A kernel that
// reads there gets 8.5e18 as a float.
class GuardedBuffer {
public:
    GuardedBuffer(Device& device, const std::string& name, std::span<const std::byte> content);

    const Buffer& buffer() const { return buffer_; }
    std::uint64_t size() const { return size_; }  // bytes, without the guard
    // The first byte of the guard that is not as it was, counted from the content's end.
    std::optional<std::uint64_t> firstOverwritten() const;

private:
    Device* device_;
    std::uint64_t size_;
    Buffer buffer_;
};

}  // namespace glim
