// Drivers that lack a part of Vulkan, such as MoltenVK: loaders hide them unless a program asks, and they demand an extension. The calls
// below stand before those of the Vulkan library.
#include "host/gpu/device.hpp"

#include <gtest/gtest.h>

#include <dlfcn.h>

#include <cstring>
#include <set>

namespace {

struct Portability {
    bool loaderHidesDevices = false, deviceLacksParts = false;
    std::set<std::string> instanceExtensions, deviceExtensions;  // that glim asked for
    VkInstanceCreateFlags instanceFlags = 0;
};

Portability* portability = nullptr;

constexpr const char* kPortabilitySubset = "VK_KHR_portability_subset";

template <class Function>
Function nextOf(const char* name)
{
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

// What the driver of the tests knows of the extensions that glim asked for.
template <class Info>
std::vector<const char*> without(const char* extension, const Info& info)
{
    std::vector<const char*> names(info.ppEnabledExtensionNames, info.ppEnabledExtensionNames + info.enabledExtensionCount);
    std::erase_if(names, [extension](const char* name) { return std::strcmp(name, extension) == 0; });
    return names;
}

// The list as Vulkan gives it, by count first.
VkResult give(const std::vector<const char*>& names, uint32_t* count, VkExtensionProperties* properties)
{
    for (uint32_t i = 0; properties != nullptr && i < *count; ++i) {
        properties[i] = {};
        std::strcpy(properties[i].extensionName, names[i]);
    }
    *count = static_cast<uint32_t>(names.size());
    return VK_SUCCESS;
}

}  // namespace

extern "C" {

VkResult vkEnumerateInstanceExtensionProperties(const char* layer, uint32_t* count, VkExtensionProperties* properties)
{
    static const auto next = nextOf<PFN_vkEnumerateInstanceExtensionProperties>("vkEnumerateInstanceExtensionProperties");
    if (portability == nullptr) {
        return next(layer, count, properties);
    }
    return give(portability->loaderHidesDevices ? std::vector{VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME} : std::vector<const char*>(),
                count, properties);
}

VkResult vkCreateInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* callbacks, VkInstance* instance)
{
    static const auto next = nextOf<PFN_vkCreateInstance>("vkCreateInstance");
    if (portability == nullptr) {
        return next(info, callbacks, instance);
    }
    portability->instanceFlags = info->flags;
    portability->instanceExtensions = {info->ppEnabledExtensionNames, info->ppEnabledExtensionNames + info->enabledExtensionCount};
    const std::vector<const char*> real = without(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME, *info);
    VkInstanceCreateInfo plain = *info;
    plain.flags = 0;
    plain.enabledExtensionCount = static_cast<uint32_t>(real.size());
    plain.ppEnabledExtensionNames = real.data();
    return next(&plain, callbacks, instance);
}

VkResult vkEnumerateDeviceExtensionProperties(VkPhysicalDevice device, const char* layer, uint32_t* count,
                                              VkExtensionProperties* properties)
{
    static const auto next = nextOf<PFN_vkEnumerateDeviceExtensionProperties>("vkEnumerateDeviceExtensionProperties");
    if (portability == nullptr) {
        return next(device, layer, count, properties);
    }
    return give(portability->deviceLacksParts ? std::vector{VK_KHR_SWAPCHAIN_EXTENSION_NAME, kPortabilitySubset}
                                              : std::vector{VK_KHR_SWAPCHAIN_EXTENSION_NAME},
                count, properties);
}

VkResult vkCreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info, const VkAllocationCallbacks* callbacks, VkDevice* device)
{
    static const auto next = nextOf<PFN_vkCreateDevice>("vkCreateDevice");
    if (portability == nullptr) {
        return next(physical, info, callbacks, device);
    }
    portability->deviceExtensions = {info->ppEnabledExtensionNames, info->ppEnabledExtensionNames + info->enabledExtensionCount};
    const std::vector<const char*> real = without(kPortabilitySubset, *info);
    VkDeviceCreateInfo plain = *info;
    plain.enabledExtensionCount = static_cast<uint32_t>(real.size());
    plain.ppEnabledExtensionNames = real.data();
    return next(physical, &plain, callbacks, device);
}

}  // extern "C"

namespace glim {
namespace {

class PortabilityTest : public testing::Test {
protected:
    PortabilityTest() { portability = &seen_; }
    ~PortabilityTest() override { portability = nullptr; }

    Portability seen_;
};

TEST_F(PortabilityTest, HiddenDevicesAreAskedFor)
{
    seen_.loaderHidesDevices = true;
    const VulkanInstance instance;
    EXPECT_EQ(seen_.instanceFlags, VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR);
    EXPECT_TRUE(seen_.instanceExtensions.contains(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME));
}

TEST_F(PortabilityTest, ALoaderThatHidesNothingIsNotAsked)
{
    const VulkanInstance instance;
    EXPECT_EQ(seen_.instanceFlags, 0U);
    EXPECT_FALSE(seen_.instanceExtensions.contains(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME));
}

TEST_F(PortabilityTest, WhatADeviceDemandsIsEnabledAndNothingElse)
{
    const VulkanInstance instance;
    for (const bool lacksParts : {true, false}) {
        seen_.deviceLacksParts = lacksParts;
        const Device device(instance);
        EXPECT_EQ(seen_.deviceExtensions, lacksParts ? std::set<std::string>{kPortabilitySubset} : std::set<std::string>());
    }
}

}  // namespace
}  // namespace glim
