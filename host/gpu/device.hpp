// A Vulkan device chosen for compute, with one queue that one thread owns.
#pragma once

#include "host/gpu/instance.hpp"

#include <optional>
#include <string>
#include <vector>

namespace glim {

// What matters of a device to someone choosing one.
struct DeviceDescription {
    std::string name;
    std::string driver;
    std::string kind;      // "discrete GPU", "integrated GPU", "virtual GPU", "software", "other"
    bool software = false; // a CPU pretends
    std::uint32_t subgroupSize = 0;
    std::uint64_t memory = 0;             // bytes of the largest device-local heap
    std::uint64_t maxAllocation = 0;      // bytes in one allocation
    std::uint64_t maxStorageBuffer = 0;   // bytes a kernel can see of one storage buffer
    std::uint64_t maxTexelElements = 0;   // 16-byte texels a kernel can see of one texel buffer
    std::uint32_t maxStorageBuffers = 0;  // per kernel
    std::uint32_t maxWorkgroup = 0;       // invocations
    std::uint32_t maxGroups = 0;          // workgroups of one dispatch along x
    float nanosecondsPerTick = 0.0F;      // 0: no timestamps
    std::uint64_t tickMask = 0;           // the bits of a timestamp that count; it wraps beyond
    std::string missing;                  // what glim needs and this device lacks; empty if usable
};

// All devices that Vulkan shows, best first: discrete, integrated, virtual, software; in Vulkan's order within a kind.
std::vector<DeviceDescription> listDevices(const Instance& instance);

class Device {
public:
    // `choice`: an index into listDevices or a part of a name (any case); absent: the first usable one. With `surface` only one
    // that can show pictures there is usable. Throws InputError if the choice names nothing or cannot show pictures,
    // DeviceError if there is no usable device.
    explicit Device(const Instance& instance, const std::optional<std::string>& choice = {},
                    VkSurfaceKHR surface = VK_NULL_HANDLE);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const Instance& instance() const { return instance_; }
    const DeviceDescription& description() const { return description_; }
    VkPhysicalDevice physical() const { return physical_; }
    VkDevice handle() const { return handle_; }
    VkQueue queue() const { return queue_; }
    std::uint32_t queueFamily() const { return queueFamily_; }

    // A memory type among `allowed` (bits) with `wanted` and, if there is one, also `preferred` properties.
    std::uint32_t findMemoryType(std::uint32_t allowed, VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred,
                                 VkMemoryPropertyFlags* chosen) const;

    // Bytes of device memory in use and at most in use so far; Buffer keeps them.
    void addMemory(std::int64_t bytes);
    std::uint64_t peakMemory() const { return peakMemory_; }

    // Gives an object a name for the debugger, where one listens.
    void setName(VkObjectType type, std::uint64_t object, const std::string& name) const;

private:
    const Instance& instance_;
    DeviceDescription description_;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice handle_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queueFamily_ = 0;
    std::uint64_t memory_ = 0, peakMemory_ = 0;
    PFN_vkSetDebugUtilsObjectNameEXT setObjectName_ = nullptr;
};

}  // namespace glim
