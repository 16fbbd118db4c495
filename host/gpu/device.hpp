// A Vulkan device for compute, with one queue. One thread uses the queue.
#pragma once

#include "host/gpu/arithmetic.hpp"
#include "host/gpu/device_class.hpp"
#include "host/gpu/instance.hpp"
#include "host/gpu/pipeline_cache.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glim {

struct DeviceDescription {
    std::string name;
    std::string driver;
    std::string kind;  // "discrete GPU", "integrated GPU", "virtual GPU", "software", "other"
    DeviceClass deviceClass = DeviceClass::SharedGpu;
    std::uint32_t subgroupSize = 0;
    std::uint64_t memory = 0;             // bytes of the largest device-local heap
    std::uint64_t maxAllocation = 0;      // bytes in one allocation
    std::uint32_t maxAllocations = 0;     // at a time
    std::uint64_t maxStorageBuffer = 0;   // bytes of a storage buffer that a kernel can address
    std::uint64_t maxTexelElements = 0;   // 16-byte texels of a texel buffer that a kernel can address
    std::uint32_t maxStorageBuffers = 0;  // per kernel
    std::uint32_t maxTexelBuffers = 0;    // per kernel
    std::uint32_t maxResources = 0;       // per kernel: buffers and images of all kinds
    std::uint32_t maxWorkgroup = 0;       // invocations
    std::uint32_t maxGroups = 0;          // workgroups of one dispatch along x
    float nanosecondsPerTick = 0.0F;      // 0: no timestamps
    std::uint64_t tickMask = 0;           // the valid bits of a timestamp, which wraps beyond them
    Arithmetic arithmetic;                // that its kernels need
    std::string missing;                  // the first feature that glim needs and this device lacks; empty if usable
};

// The address space that a software driver needs, most of it while it compiles. Some crash without (shaders/driver_bugs.md).
std::uint64_t driverAddresses();

// All devices that Vulkan shows, best first: discrete, integrated, virtual, other, software. Vulkan's order decides within a kind.
std::vector<DeviceDescription> listDevices(const VulkanInstance& instance);

class Reused;

// The first memory type of `allowed` (a bit mask) that has the `wanted` and the `preferred` properties, or at least the `wanted` ones.
std::optional<std::uint32_t> findMemoryType(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t allowed,
                                            VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred);

class Device {
public:
    // `choice` is an index into listDevices or a part of a name in any case; without it the first usable device is taken. With
    // `surface`, a device is usable only if it can present to it. Throws InputError if the choice names no device or one that
    // cannot present, DeviceError if no device is usable. `as`: by the rules of this class; with those of a discrete GPU no memory is
    // mapped. So tests run on a software device what a GPU does.
    explicit Device(const VulkanInstance& instance, const std::optional<std::string>& choice = {}, VkSurfaceKHR surface = VK_NULL_HANDLE,
                    std::optional<DeviceClass> as = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const VulkanInstance& instance() const { return instance_; }
    const DeviceDescription& description() const { return description_; }
    // Whether the host maps memory that it shares with the device (software devices, integrated GPUs). The rest is staged.
    bool mapsShared() const { return mapsShared_; }
    VkPhysicalDevice physical() const { return physical_; }
    VkDevice handle() const { return handle_; }
    VkQueue queue() const { return queue_; }
    std::uint32_t queueFamily() const { return queueFamily_; }
    const Arithmetic& arithmetic() const { return description_.arithmetic; }
    PipelineCache& pipelines() { return *pipelines_; }
    const PipelineCache& pipelines() const { return *pipelines_; }

    // As findMemoryType below. `chosen` receives the properties. Throws DeviceError if there is none.
    std::uint32_t findMemoryType(std::uint32_t allowed, VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred,
                                 VkMemoryPropertyFlags* chosen) const;

    // What submissions leave to the next ones (reused.hpp).
    Reused& reused() const { return *reused_; }

    // Adds to the bytes of device memory in use. Buffers and images call it for each allocation, with negative bytes when they free it.
    void addMemory(std::int64_t bytes);
    std::uint32_t allocations() const { return allocations_; }  // of buffers and images, not of the host's staging buffers
    std::uint64_t peakMemory() const { return peakMemory_; }    // the most bytes in use so far

    // Names an object for a debugger, if one listens.
    void setName(VkObjectType type, std::uint64_t object, const std::string& name) const;

private:
    const VulkanInstance& instance_;
    DeviceDescription description_;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice handle_ = VK_NULL_HANDLE;
    std::optional<PipelineCache> pipelines_;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queueFamily_ = 0;
    bool mapsShared_;
    std::uint64_t memory_ = 0, peakMemory_ = 0;
    std::uint32_t allocations_ = 0;
    PFN_vkSetDebugUtilsObjectNameEXT setObjectName_ = nullptr;
    std::unique_ptr<Reused> reused_;
};

}  // namespace glim
