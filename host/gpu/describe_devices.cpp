#include "host/gpu/describe_devices.hpp"

#include <algorithm>
#include <optional>

namespace glim {
namespace {

std::string nameOf(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return "software";
    default: return "other";
    }
}

int rank(const DeviceDescription& description)
{
    static const char* const kinds[] = {"discrete GPU", "integrated GPU", "virtual GPU", "other", "software"};
    return static_cast<int>(std::find(std::begin(kinds), std::end(kinds), description.kind) - std::begin(kinds));
}

std::uint64_t largestLocalHeap(VkPhysicalDevice physical)
{
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    std::uint64_t largest = 0;
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
        if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0) {
            largest = std::max<std::uint64_t>(largest, memory.memoryHeaps[i].size);
        }
    }
    return largest;
}

// The first queue family that computes, or none; with its timestamp bits.
std::optional<std::pair<std::uint32_t, std::uint32_t>> findComputeFamily(VkPhysicalDevice physical)
{
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    for (std::uint32_t i = 0; i < count; ++i) {
        if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) != 0) {
            return {{i, families[i].timestampValidBits}};
        }
    }
    return {};
}

std::string findMissing(VkPhysicalDevice physical, std::uint32_t version)
{
    if (version < VK_API_VERSION_1_2) {
        return "Vulkan 1.2";
    }
    VkPhysicalDeviceVulkan12Features features12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &features12, {}};
    vkGetPhysicalDeviceFeatures2(physical, &features);
    if (features12.scalarBlockLayout == VK_FALSE) {
        return "scalarBlockLayout";
    }
    if (features12.hostQueryReset == VK_FALSE) {
        return "hostQueryReset";
    }
    VkPhysicalDeviceVulkan12Properties properties12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &properties12, {}};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    // Infinite distances are real ones in the kernels, and comparisons guard against NaN.
    return properties12.shaderSignedZeroInfNanPreserveFloat32 == VK_FALSE ? "shaderSignedZeroInfNanPreserveFloat32" : "";
}

Candidate describe(VkPhysicalDevice physical)
{
    VkPhysicalDeviceMaintenance3Properties allocation{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES, &allocation};
    VkPhysicalDeviceSubgroupProperties subgroup{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, &driver};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroup, {}};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    const VkPhysicalDeviceLimits& limits = properties.properties.limits;

    DeviceDescription d;
    d.name = properties.properties.deviceName;
    d.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    d.kind = nameOf(properties.properties.deviceType);
    d.software = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    d.subgroupSize = subgroup.subgroupSize;
    d.memory = largestLocalHeap(physical);
    d.maxAllocation = allocation.maxMemoryAllocationSize;
    d.maxStorageBuffer = limits.maxStorageBufferRange;
    d.maxTexelElements = limits.maxTexelBufferElements;
    d.maxStorageBuffers = limits.maxPerStageDescriptorStorageBuffers;
    d.maxWorkgroup = limits.maxComputeWorkGroupInvocations;
    d.maxGroups = limits.maxComputeWorkGroupCount[0];
    d.missing = findMissing(physical, properties.properties.apiVersion);
    const auto family = findComputeFamily(physical);
    if (!family) {
        d.missing = "a compute queue";
    } else if (family->second != 0) {
        d.nanosecondsPerTick = limits.timestampPeriod;
        d.tickMask = ~std::uint64_t{0} >> (64 - family->second);
    }
    return {physical, family ? family->first : 0, d};
}

}  // namespace

std::vector<Candidate> findCandidates(const Instance& instance)
{
    std::vector<Candidate> candidates;
    for (VkPhysicalDevice physical : instance.physicalDevices()) {
        candidates.push_back(describe(physical));
    }
    std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return rank(a.description) < rank(b.description);
    });
    return candidates;
}

std::vector<DeviceDescription> listDevices(const Instance& instance)
{
    std::vector<DeviceDescription> descriptions;
    for (const Candidate& candidate : findCandidates(instance)) {
        descriptions.push_back(candidate.description);
    }
    return descriptions;
}

}  // namespace glim
