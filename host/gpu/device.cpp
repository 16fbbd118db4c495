#include "host/gpu/describe_devices.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <optional>

namespace glim {
namespace {

std::string lowerCase(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

std::string listOf(const std::vector<Candidate>& candidates)
{
    std::string list;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        list += (i == 0 ? "" : ", ") + std::to_string(i) + " \"" + candidates[i].description.name + "\"";
    }
    return list.empty() ? "none" : list;
}

// A number is an index and never part of a name: many names have digits.
bool isNamedBy(const std::string& choice, std::size_t index, const DeviceDescription& description)
{
    if (choice.find_first_not_of("0123456789") == std::string::npos) {
        return choice == std::to_string(index);
    }
    return lowerCase(description.name).find(lowerCase(choice)) != std::string::npos;
}

bool canShow(const Candidate& candidate, VkSurfaceKHR surface)
{
    std::uint32_t count = 0;
    check(vkEnumerateDeviceExtensionProperties(candidate.physical, nullptr, &count, nullptr), "list extensions");
    std::vector<VkExtensionProperties> extensions(count);
    check(vkEnumerateDeviceExtensionProperties(candidate.physical, nullptr, &count, extensions.data()), "list extensions");
    const bool swaps = std::any_of(extensions.begin(), extensions.end(), [](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, VK_KHR_SWAPCHAIN_EXTENSION_NAME) == 0;
    });
    VkBool32 presents = VK_FALSE;
    return swaps &&
           vkGetPhysicalDeviceSurfaceSupportKHR(candidate.physical, candidate.queueFamily, surface, &presents) == VK_SUCCESS &&
           presents == VK_TRUE;
}

Candidate choose(const Instance& instance, const std::optional<std::string>& choice, VkSurfaceKHR surface)
{
    const std::vector<Candidate> candidates = findCandidates(instance);
    std::string blind;  // devices that cannot show pictures in this window
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const DeviceDescription& d = candidates[i].description;
        if (choice ? !isNamedBy(*choice, i, d) : !d.missing.empty()) {
            continue;
        }
        if (!d.missing.empty()) {
            throw DeviceError("Device \"" + d.name + "\" lacks " + d.missing + ", which glim needs.");
        }
        if (surface == VK_NULL_HANDLE || canShow(candidates[i], surface)) {
            return candidates[i];
        }
        blind += (blind.empty() ? "\"" : ", \"") + d.name + "\"";
    }
    if (!blind.empty()) {
        throw InputError("This window cannot show pictures of " + blind + "; `glim render` writes them to a file instead.");
    }
    if (choice) {
        throw InputError("--device " + *choice + ": no such device; there are: " + listOf(candidates) + ".");
    }
    throw DeviceError("No usable Vulkan device; found: " + listOf(candidates) +
                      " (a software one comes with Debian's mesa-vulkan-drivers).");
}

}  // namespace

Device::Device(const Instance& instance, const std::optional<std::string>& choice, VkSurfaceKHR surface) : instance_(instance)
{
    const Candidate chosen = choose(instance, choice, surface);
    description_ = chosen.description;
    physical_ = chosen.physical;
    queueFamily_ = chosen.queueFamily;

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
    const char* swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    info.enabledExtensionCount = surface == VK_NULL_HANDLE ? 0 : 1;
    info.ppEnabledExtensionNames = &swapchain;
    check(vkCreateDevice(physical_, &info, nullptr, &handle_), "open device \"" + description_.name + "\"");
    vkGetDeviceQueue(handle_, queueFamily_, 0, &queue_);
    setObjectName_ = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
        vkGetInstanceProcAddr(instance.handle(), "vkSetDebugUtilsObjectNameEXT"));
}

Device::~Device() { vkDestroyDevice(handle_, nullptr); }

std::uint32_t Device::findMemoryType(std::uint32_t allowed, VkMemoryPropertyFlags wanted,
                                     VkMemoryPropertyFlags preferred, VkMemoryPropertyFlags* chosen) const
{
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
    for (const VkMemoryPropertyFlags flags : {wanted | preferred, wanted}) {
        for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
            const VkMemoryPropertyFlags have = memory.memoryTypes[i].propertyFlags;
            if ((allowed >> i & 1U) != 0 && (have & flags) == flags) {
                *chosen = have;
                return i;
            }
        }
    }
    throw DeviceError("Device \"" + description_.name + "\" has no memory with the properties that a buffer needs.");
}

void Device::addMemory(std::int64_t bytes)
{
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
