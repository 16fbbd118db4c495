// Device memory with a buffer over it.
#pragma once

#include "host/gpu/device.hpp"

#include <cstring>
#include <span>
#include <type_traits>

namespace glim {

enum class BufferKind {
    Storage,   // read and written by kernels; also an indirect dispatch's arguments
    Texel,     // read by kernels as 16-byte texels (uvec4)
    Both,      // as Storage, and as texels at another binding
    Readback,  // as Storage, and cheap for the host to read
};

constexpr bool hasTexels(BufferKind kind) { return kind == BufferKind::Texel || kind == BufferKind::Both; }
constexpr bool hasStorage(BufferKind kind) { return kind != BufferKind::Texel; }

class Buffer {
public:
    // `size` in bytes, at least 1. Throws DeviceError with the name, the size and the limit where the device cannot.
    Buffer(Device& device, const std::string& name, BufferKind kind, std::uint64_t size);
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&&) = delete;

    VkBuffer handle() const { return handle_; }
    VkBufferView texelView() const { return view_; }
    BufferKind kind() const { return kind_; }
    std::uint64_t size() const { return size_; }

    // Copies all of `bytes` to the start of the buffer; no kernel that uses it may be running.
    void upload(std::span<const std::byte> bytes);
    // Copies the first bytes of the buffer out.
    void download(std::span<std::byte> bytes) const;

private:
    void allocate(const std::string& name);

    Device* device_;
    BufferKind kind_;
    std::uint64_t size_;
    VkBuffer handle_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkBufferView view_ = VK_NULL_HANDLE;
    std::uint64_t allocated_ = 0;
    std::byte* mapped_ = nullptr;  // null where the host cannot see the memory
};

template <class T>
void upload(Buffer& buffer, std::span<const T> values)
{
    static_assert(std::is_trivially_copyable_v<T>);
    buffer.upload(std::as_bytes(values));
}

template <class T>
std::vector<T> download(const Buffer& buffer, std::size_t count)
{
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> values(count);
    buffer.download(std::as_writable_bytes(std::span<T>(values)));
    return values;
}

}  // namespace glim
