#include "host/gpu/buffer.hpp"

#include "host/gpu/commands.hpp"

#include <algorithm>
#include <cassert>

namespace glim {
namespace {

std::uint64_t texelBytes(BufferKind kind) { return kind == BufferKind::Texel4 ? 4 : kind == BufferKind::Texel8 ? 8 : 16; }

VkFormat texelFormat(BufferKind kind)
{
    return kind == BufferKind::Texel4   ? VK_FORMAT_R8G8B8A8_UINT
           : kind == BufferKind::Texel8 ? VK_FORMAT_R32G32_UINT
                                        : VK_FORMAT_R32G32B32A32_UINT;
}

VkBufferUsageFlags getUsage(BufferKind kind)
{
    const VkBufferUsageFlags texels = hasTexels(kind) ? VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT : 0;
    const VkBufferUsageFlags storage = hasStorage(kind) ? VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT : 0;
    return VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | texels | storage;
}

std::string megabytes(std::uint64_t bytes) { return std::to_string((bytes + (1U << 20) - 1) >> 20) + " MiB"; }

// The most bytes of a buffer of this kind that a kernel can address.
std::uint64_t getLimit(const DeviceDescription& device, BufferKind kind)
{
    const std::uint64_t texels = device.maxTexelElements * texelBytes(kind);
    return !hasStorage(kind) ? texels : kind == BufferKind::Both ? std::min(texels, device.maxStorageBuffer) : device.maxStorageBuffer;
}

void refuseTooLarge(const DeviceDescription& device, const std::string& name, BufferKind kind, std::uint64_t size)
{
    const std::uint64_t limit = std::min(getLimit(device, kind), device.maxAllocation);
    if (size > limit) {
        throw DeviceError(MessageId::DeviceLimit,
                          {"The ", part::place(name), " need ", part::value(megabytes(size)), ", which is ", megabytes(size - limit),
                           " more than device \"", device.name, "\" allows in one buffer (", part::expected(megabytes(limit)), ")."});
    }
}

}  // namespace

void refuseIfOutOfMemory(VkResult result, const std::string& name, std::uint64_t bytes, const DeviceDescription& device)
{
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
        throw DeviceError(MessageId::OutOfMemory,
                          {"The ", part::place(name), " need ", part::value(megabytes(bytes)), ", but device \"", device.name,
                           "\" has no more memory (of ", part::expected(megabytes(device.memory)), ")."});
    }
}

Buffer::Buffer(Device& device, const std::string& name, BufferKind kind, std::uint64_t size)
    : device_(&device),
      kind_(kind),
      size_(size),
      memory_(device),
      handle_(device),
      view_(device)
{
    refuseTooLarge(device.description(), name, kind, size);
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = size;
    info.usage = getUsage(kind);
    check(vkCreateBuffer(device.handle(), &info, nullptr, handle_.receive()), "create the buffer of the " + name);
    allocate(name);
    device.setName(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(handle_.get()), name);
    if (hasTexels(kind)) {
        VkBufferViewCreateInfo view{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
        view.buffer = handle_.get();
        view.format = texelFormat(kind);
        view.range = VK_WHOLE_SIZE;
        check(vkCreateBufferView(device.handle(), &view, nullptr, view_.receive()), "create the texel view of the " + name);
    }
}

void Buffer::allocate(const std::string& name)
{
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_->handle(), handle_.get(), &needs);
    // Device memory that is also host-cached is memory that both share. A discrete GPU may also expose some of its own memory to the
    // host, but that is small (256 MiB) or slow to read, and stays unmapped.
    const VkMemoryPropertyFlags shared = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                         VK_MEMORY_PROPERTY_HOST_COHERENT_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    VkMemoryPropertyFlags have = 0;
    VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = device_->findMemoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, shared, &have);
    const bool mappable = device_->mapsShared() && (have & shared) == shared;
    const VkResult result = memory_.allocate(allocation);
    refuseIfOutOfMemory(result, name, needs.size, device_->description());
    if (result == VK_ERROR_TOO_MANY_OBJECTS) {
        throw DeviceError(MessageId::DeviceLimit,
                          {"The ", part::place(name), " need one more allocation of memory than device \"", device_->description().name,
                           "\" allows (", part::expected(std::to_string(device_->description().maxAllocations)), ")."});
    }
    check(result, "allocate the " + name);
    check(vkBindBufferMemory(device_->handle(), handle_.get(), memory_.get(), 0), "bind the memory of the " + name);
    if (mappable) {
        void* mapped = nullptr;
        check(vkMapMemory(device_->handle(), memory_.get(), 0, VK_WHOLE_SIZE, 0, &mapped), "map the " + name);
        mapped_ = static_cast<std::byte*>(mapped);
    } else if (kind_ == BufferKind::Readback) {
        hostCopy_ = std::make_unique<HostCopy>(device_->reused(), *device_, handle_.get(), size_);
    }
}

void Buffer::upload(std::span<const std::byte> bytes)
{
    assert(bytes.size() <= size_);
    if (bytes.empty()) {
        return;
    }
    if (mapped_ != nullptr) {
        std::memcpy(mapped_, bytes.data(), bytes.size());
        return;
    }
    const HostBuffer& staging = device_->reused().staging();
    for (std::uint64_t offset = 0; offset < bytes.size(); offset += kStagingBytes) {
        const std::uint64_t count = std::min<std::uint64_t>(bytes.size() - offset, kStagingBytes);
        std::memcpy(staging.mapped(), bytes.data() + offset, count);
        Commands commands(*device_);
        commands.copy(staging.handle(), 0, handle_.get(), count, offset);
        commands.submitAndWait();
    }
}

void Buffer::download(std::span<std::byte> bytes) const
{
    assert(bytes.size() <= size_);
    if (bytes.empty()) {
        return;
    }
    if (mapped_ != nullptr || hostCopy_) {
        std::memcpy(bytes.data(), mapped_ != nullptr ? mapped_ : hostCopy_->mapped(), bytes.size());
        return;
    }
    const HostBuffer& staging = device_->reused().staging();
    for (std::uint64_t offset = 0; offset < bytes.size(); offset += kStagingBytes) {
        const std::uint64_t count = std::min<std::uint64_t>(bytes.size() - offset, kStagingBytes);
        Commands commands(*device_);
        commands.copy(handle_.get(), offset, staging.handle(), count);
        commands.submitAndWait();
        std::memcpy(bytes.data() + offset, staging.mapped(), count);
    }
}

}  // namespace glim
