// Vulkan objects that destroy themselves. A class whose members they are leaves nothing behind if a later step of its constructor fails.
#pragma once

#include "host/gpu/device.hpp"

#include <utility>

namespace glim {

template <class Object, void (*destroy)(VkDevice, Object, const VkAllocationCallbacks*)>
class Owned {
public:
    explicit Owned(const Device& device)
        : device_(device.handle())
    {}
    ~Owned() { reset(); }
    Owned(Owned&& other) noexcept
        : device_(other.device_),
          object_(std::exchange(other.object_, VK_NULL_HANDLE))
    {}
    Owned& operator=(Owned&& other) noexcept
    {
        reset();
        device_ = other.device_;
        object_ = std::exchange(other.object_, VK_NULL_HANDLE);
        return *this;
    }

    // Where Vulkan's functions write what they make. Destroys what was there.
    Object* receive()
    {
        reset();
        return &object_;
    }
    void reset()
    {
        if (object_ != VK_NULL_HANDLE) {
            destroy(device_, std::exchange(object_, VK_NULL_HANDLE), nullptr);
        }
    }
    Object get() const { return object_; }
    const Object* address() const { return &object_; }

private:
    VkDevice device_;
    Object object_ = VK_NULL_HANDLE;
};

// Memory of the device, which counts it.
class OwnedMemory {
public:
    explicit OwnedMemory(Device& device)
        : device_(&device),
          memory_(device)
    {}
    ~OwnedMemory() { device_->addMemory(-static_cast<std::int64_t>(bytes_)); }
    OwnedMemory(OwnedMemory&& other) noexcept
        : device_(other.device_),
          memory_(std::move(other.memory_)),
          bytes_(std::exchange(other.bytes_, 0))
    {}
    OwnedMemory& operator=(OwnedMemory&&) = delete;

    VkResult allocate(const VkMemoryAllocateInfo& info)
    {
        const VkResult result = vkAllocateMemory(device_->handle(), &info, nullptr, memory_.receive());
        bytes_ = result == VK_SUCCESS ? info.allocationSize : 0;
        device_->addMemory(static_cast<std::int64_t>(bytes_));
        return result;
    }
    VkDeviceMemory get() const { return memory_.get(); }

private:
    Device* device_;
    Owned<VkDeviceMemory, vkFreeMemory> memory_;
    std::uint64_t bytes_ = 0;
};

}  // namespace glim
