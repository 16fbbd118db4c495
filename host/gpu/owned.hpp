// Vulkan objects that destroy themselves. If a constructor throws, its members of these types destroy what they hold.
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

    // The address that a Vulkan function writes a new handle to. Destroys the object held before.
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

// Device memory. The Device counts its bytes.
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

    // VK_ERROR_TOO_MANY_OBJECTS if the device allows no more.
    VkResult allocate(const VkMemoryAllocateInfo& info)
    {
        constexpr std::uint32_t kForStaging = 64;  // more than there are staging buffers
        if (device_->allocations() + kForStaging >= device_->description().maxAllocations) {
            return VK_ERROR_TOO_MANY_OBJECTS;
        }
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
