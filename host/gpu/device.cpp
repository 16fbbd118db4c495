#include "host/gpu/device.hpp"

#include "host/gpu/reused.hpp"
#include "host/memory.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <thread>

namespace glim {
namespace {

struct Candidate {
    VkPhysicalDevice physical;
    std::uint32_t queueFamily;
    DeviceDescription description;
};

std::string nameOfKind(VkPhysicalDeviceType type)
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

std::vector<VkQueueFamilyProperties> queueFamilies(VkPhysicalDevice physical)
{
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    return families;
}

// The index of the first compute queue family and the number of valid bits of its timestamps.
std::optional<std::pair<std::uint32_t, std::uint32_t>> findComputeFamily(VkPhysicalDevice physical)
{
    const std::vector<VkQueueFamilyProperties> families = queueFamilies(physical);
    for (std::uint32_t i = 0; i < families.size(); ++i) {
        if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) != 0) {
            return {{i, families[i].timestampValidBits}};
        }
    }
    return {};
}

// The first feature that glim needs and the device lacks; empty if there is none.
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
    // The kernels compute with infinite distances and compare with NaN.
    return properties12.shaderSignedZeroInfNanPreserveFloat32 == VK_FALSE ? "shaderSignedZeroInfNanPreserveFloat32" : "";
}

Candidate describe(VkPhysicalDevice physical)
{
    VkPhysicalDeviceMaintenance3Properties allocation{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceFloatControlsProperties floats{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES, &allocation};
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES, &floats};
    VkPhysicalDeviceSubgroupProperties subgroup{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, &driver};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroup, {}};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    const VkPhysicalDeviceLimits& limits = properties.properties.limits;

    DeviceDescription d;
    d.name = properties.properties.deviceName;
    d.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    d.kind = nameOfKind(properties.properties.deviceType);
    d.deviceClass = classify(properties.properties.deviceType, driver.driverID);
    d.subgroupSize = subgroup.subgroupSize;
    d.memory = largestLocalHeap(physical);
    d.maxAllocation = allocation.maxMemoryAllocationSize;
    d.maxAllocations = limits.maxMemoryAllocationCount;
    d.maxStorageBuffer = limits.maxStorageBufferRange;
    d.maxTexelElements = limits.maxTexelBufferElements;
    d.maxStorageBuffers = std::min(limits.maxPerStageDescriptorStorageBuffers, limits.maxDescriptorSetStorageBuffers);
    d.maxTexelBuffers = std::min(limits.maxPerStageDescriptorSampledImages, limits.maxDescriptorSetSampledImages);
    d.maxResources = limits.maxPerStageResources;
    d.maxWorkgroup = limits.maxComputeWorkGroupInvocations;
    d.maxGroups = limits.maxComputeWorkGroupCount[0];
    d.arithmetic.exact = !dividesExactly(driver.driverID);
    d.arithmetic.declaresRounding = floats.shaderRoundingModeRTEFloat32 == VK_TRUE;
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

std::vector<Candidate> findCandidates(const VulkanInstance& instance)
{
    std::vector<Candidate> candidates;
    for (VkPhysicalDevice physical : instance.physicalDevices()) {
        candidates.push_back(describe(physical));
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return rank(a.description) < rank(b.description); });
    return candidates;
}

std::string listOf(const std::vector<Candidate>& candidates)
{
    std::string list;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const DeviceDescription& d = candidates[i].description;
        list += (i == 0 ? "" : ", ") + std::to_string(i) + " \"" + d.name + "\"" + (d.missing.empty() ? "" : ", which lacks " + d.missing);
    }
    return list.empty() ? "none" : list;
}

// A number is always an index, never a part of a name: many names contain digits.
bool isNamedBy(const std::string& choice, std::size_t index, const DeviceDescription& description)
{
    if (choice.find_first_not_of("0123456789") == std::string::npos) {
        return choice == std::to_string(index);
    }
    return lowerCase(description.name).find(lowerCase(choice)) != std::string::npos;
}

std::vector<VkExtensionProperties> deviceExtensions(VkPhysicalDevice physical)
{
    std::uint32_t count = 0;
    check(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr), "list extensions");
    std::vector<VkExtensionProperties> extensions(count);
    check(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data()), "list extensions");
    return extensions;
}

bool canPresent(const Candidate& candidate, VkSurfaceKHR surface)
{
    if ((queueFamilies(candidate.physical).at(candidate.queueFamily).queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) {
        return false;  // panels are drawn by a graphics pipeline
    }
    VkBool32 presents = VK_FALSE;
    return contains(deviceExtensions(candidate.physical), VK_KHR_SWAPCHAIN_EXTENSION_NAME) &&
           vkGetPhysicalDeviceSurfaceSupportKHR(candidate.physical, candidate.queueFamily, surface, &presents) == VK_SUCCESS &&
           presents == VK_TRUE;
}

Candidate choose(const VulkanInstance& instance, const std::optional<std::string>& choice, VkSurfaceKHR surface)
{
    const std::vector<Candidate> candidates = findCandidates(instance);
    std::string blind;  // devices that fit the choice but cannot present in this window
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const DeviceDescription& d = candidates[i].description;
        if (choice ? !isNamedBy(*choice, i, d) : !d.missing.empty()) {
            continue;
        }
        if (!d.missing.empty()) {
            throw DeviceError(MessageId::DeviceLacks,
                              {"Device ", part::quoted(d.name), " lacks ", part::expected(d.missing), ", which glim needs."});
        }
        if (surface == VK_NULL_HANDLE || canPresent(candidates[i], surface)) {
            return candidates[i];
        }
        blind += (blind.empty() ? "\"" : ", \"") + d.name + "\"";
    }
    if (!blind.empty()) {
        throw InputError(MessageId::NoWindow, {"This window cannot show pictures that are rendered by ", part::value(blind),
                                               "; `glim render` writes them to a file instead."});
    }
    if (choice) {
        throw InputError(MessageId::UnknownName, {part::place("--device"), " ", part::value(*choice),
                                                  ": no such device; there are: ", part::expected(listOf(candidates)), "."});
    }
    throw DeviceError(MessageId::DeviceMissing, {"No usable Vulkan device; found: ", part::value(listOf(candidates)),
                                                 " (a software one comes with Debian's mesa-vulkan-drivers)."});
}

}  // namespace

std::vector<DeviceDescription> listDevices(const VulkanInstance& instance)
{
    std::vector<DeviceDescription> descriptions;
    for (const Candidate& candidate : findCandidates(instance)) {
        descriptions.push_back(candidate.description);
    }
    return descriptions;
}

// Measured on two cores (2026-11-25): 1,045 MiB.
std::uint64_t driverAddresses() { return (832 + 128 * std::uint64_t{std::thread::hardware_concurrency()}) << 20U; }

Device::Device(const VulkanInstance& instance, const std::optional<std::string>& choice, VkSurfaceKHR surface,
               std::optional<DeviceClass> as)
    : instance_(instance),
      mapsShared_(as != DeviceClass::DiscreteGpu)
{
    const Candidate chosen = choose(instance, choice, surface);
    description_ = chosen.description;
    description_.deviceClass = as.value_or(description_.deviceClass);
    if (const char* const asked = std::getenv("GLIM_ARITHMETIC"); asked != nullptr && *asked != '\0') {
        description_.arithmetic = parseArithmetic(description_.arithmetic, asked);
    }
    physical_ = chosen.physical;
    queueFamily_ = chosen.queueFamily;
    if (const auto limit = addressLimit(); isSoftware(description_.deviceClass) && limit && limit->bytes < driverAddresses()) {
        throw DeviceError(MessageId::OutOfMemory,
                          {"Device \"", description_.name, "\" needs ", part::expected(std::to_string(driverAddresses() >> 20U) + " MiB"),
                           " of addresses; a limit (", part::place("ulimit -v"), ") allows the process ",
                           part::value(std::to_string(limit->bytes >> 20U) + " MiB"), "."});
    }

    const float priority = 1.0F;
    VkDeviceQueueCreateInfo queueInfo{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queueInfo.queueFamilyIndex = queueFamily_;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    VkPhysicalDeviceVulkan12Features features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    features.scalarBlockLayout = VK_TRUE;
    features.hostQueryReset = VK_TRUE;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queueInfo;
    std::vector<const char*> extensions;
    if (surface != VK_NULL_HANDLE) {
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    }
    constexpr const char* kPortabilitySubset = "VK_KHR_portability_subset";  // a device that lists it demands it
    if (contains(deviceExtensions(physical_), kPortabilitySubset)) {
        extensions.push_back(kPortabilitySubset);
    }
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    check(vkCreateDevice(physical_, &info, nullptr, &handle_), "open device \"" + description_.name + "\"");
    vkGetDeviceQueue(handle_, queueFamily_, 0, &queue_);
    pipelines_.emplace(physical_, handle_);
    setObjectName_ =
        reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(vkGetInstanceProcAddr(instance.handle(), "vkSetDebugUtilsObjectNameEXT"));
    reused_ = std::make_unique<Reused>(*this);
}

Device::~Device()
{
    reused_.reset();
    pipelines_.reset();
    vkDestroyDevice(handle_, nullptr);
}

std::optional<std::uint32_t> findMemoryType(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t allowed,
                                            VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred)
{
    for (const VkMemoryPropertyFlags flags : {wanted | preferred, wanted}) {
        for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
            if ((allowed >> i & 1U) != 0 && (memory.memoryTypes[i].propertyFlags & flags) == flags) {
                return i;
            }
        }
    }
    return {};
}

std::uint32_t Device::findMemoryType(std::uint32_t allowed, VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred,
                                     VkMemoryPropertyFlags* chosen) const
{
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
    const std::optional<std::uint32_t> found = glim::findMemoryType(memory, allowed, wanted, preferred);
    if (!found) {
        throw DeviceError(MessageId::DeviceLacks, {"Device ", part::quoted(description_.name), " has no ",
                                                   part::expected("memory with the properties that a buffer needs"), "."});
    }
    *chosen = memory.memoryTypes[*found].propertyFlags;
    return *found;
}

void Device::addMemory(std::int64_t bytes)
{
    allocations_ += bytes > 0 ? 1U : bytes < 0 ? -1U : 0U;
    memory_ += static_cast<std::uint64_t>(bytes);
    peakMemory_ = std::max(peakMemory_, memory_);
}

void Device::setName(VkObjectType type, std::uint64_t object, const std::string& name) const
{
    if (setObjectName_ == nullptr) {
        return;
    }
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = object;
    info.pObjectName = name.c_str();
    check(setObjectName_(handle_, &info), "name an object");
}

}  // namespace glim
