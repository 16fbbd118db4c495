// A buffer in device memory, and the copies between it and the host.
#pragma once

#include "host/gpu/reused.hpp"

#include <cstring>
#include <span>
#include <type_traits>

namespace glim {

// Throws DeviceError that says how much what is named asks for, if the device or its driver has no more memory.
void refuseIfOutOfMemory(VkResult result, const std::string& name, std::uint64_t bytes, const DeviceDescription& device);

enum class BufferKind {
    Storage,   // read and written by kernels; also an indirect dispatch's arguments
    Texel,     // read by kernels as 16-byte texels (uvec4)
    Texel8,    // as texels of 8 bytes (uvec2)
    Texel4,    // as texels of 4 bytes, each one number (uvec4 of bytes)
    Both,      // as Storage, and as texels at another binding
    Readback,  // as Storage, but small: the host has a copy, which each wait brings up to date
};

constexpr bool hasTexels(BufferKind kind) { return kind != BufferKind::Storage && kind != BufferKind::Readback; }
constexpr bool hasStorage(BufferKind kind)
{
    return kind == BufferKind::Storage || kind == BufferKind::Both || kind == BufferKind::Readback;
}

class Buffer {
public:
    // `size` is in bytes, at least 1. Throws DeviceError with the name, the size and the limit if the device does not allow it.
    Buffer(Device& device, const std::string& name, BufferKind kind, std::uint64_t size);

    VkBuffer handle() const { return handle_.get(); }
    VkBufferView texelView() const { return view_.get(); }
    BufferKind kind() const { return kind_; }
    std::uint64_t size() const { return size_; }
    bool isMapped() const { return mapped_ != nullptr; }

    // Copies `bytes` to the start of the buffer. No kernel that uses the buffer may be running.
    void upload(std::span<const std::byte> bytes);
    // Copies the first bytes of the buffer to `bytes`.
    void download(std::span<std::byte> bytes) const;

private:
    void allocate(const std::string& name);

    Device* device_;
    BufferKind kind_;
    std::uint64_t size_;
    OwnedMemory memory_;  // outlives the buffer
    Owned<VkBuffer, vkDestroyBuffer> handle_;
    Owned<VkBufferView, vkDestroyBufferView> view_;
    std::byte* mapped_ = nullptr;  // null if host copies are staged
    std::unique_ptr<HostCopy> hostCopy_;
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
