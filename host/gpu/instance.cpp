#include "host/gpu/instance.hpp"

#include "host/memory.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace glim {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

// Vulkan's name of a failure. (vk::to_string would cost its only user 3.6 s of compilation.)
std::string nameOfResult(VkResult result)
{
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY: return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY: return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED: return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST: return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_MEMORY_MAP_FAILED: return "VK_ERROR_MEMORY_MAP_FAILED";
    case VK_ERROR_LAYER_NOT_PRESENT: return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT: return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT: return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER: return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_TOO_MANY_OBJECTS: return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_OUT_OF_POOL_MEMORY: return "VK_ERROR_OUT_OF_POOL_MEMORY";
    case VK_ERROR_SURFACE_LOST_KHR: return "VK_ERROR_SURFACE_LOST_KHR";
    case VK_ERROR_NATIVE_WINDOW_IN_USE_KHR: return "VK_ERROR_NATIVE_WINDOW_IN_USE_KHR";
    case VK_ERROR_OUT_OF_DATE_KHR: return "VK_ERROR_OUT_OF_DATE_KHR";
    default: return "VkResult " + std::to_string(result);
    }
}

VKAPI_ATTR VkBool32 VKAPI_CALL countMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* counter)
{
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    ++*static_cast<std::atomic<int>*>(counter);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(std::atomic<int>* counter)
{
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = countMessage;
    info.pUserData = counter;
    return info;
}

bool wantsValidation()
{
    const char* value = std::getenv("GLIM_VALIDATION");
    return value != nullptr && std::strcmp(value, "1") == 0;
}

void requireValidationLayer()
{
    std::uint32_t count = 0;
    check(vkEnumerateInstanceLayerProperties(&count, nullptr), "list layers");
    std::vector<VkLayerProperties> layers(count);
    check(vkEnumerateInstanceLayerProperties(&count, layers.data()), "list layers");
    const bool found = std::any_of(layers.begin(), layers.end(),
                                   [](const VkLayerProperties& layer) { return std::strcmp(layer.layerName, kValidationLayer) == 0; });
    if (!found) {
        throw DeviceError(MessageId::LibraryMissing, {part::place("GLIM_VALIDATION"), "=1 asks for ", part::value(kValidationLayer),
                                                      ", which is not installed (Debian: vulkan-validationlayers)."});
    }
}

std::vector<VkExtensionProperties> instanceExtensions()
{
    std::uint32_t count = 0;
    check(vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr), "list the instance's extensions");
    std::vector<VkExtensionProperties> extensions(count);
    check(vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data()), "list the instance's extensions");
    return extensions;
}

}  // namespace

bool contains(const std::vector<VkExtensionProperties>& extensions, const char* name)
{
    return std::ranges::any_of(extensions, [name](const auto& extension) { return std::strcmp(extension.extensionName, name) == 0; });
}

void check(VkResult result, const std::string& action)
{
    if (result < 0) {
        const std::optional<AddressLimit> limit = addressLimit();
        const bool noMemory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
        throw DeviceError(noMemory ? MessageId::OutOfMemory : MessageId::DriverFailed,
                          {"Vulkan could not ", part::place(action), ": ", part::value(nameOfResult(result)),
                           limit ? "; of the addresses that a limit (ulimit -v) allows the process, " + std::to_string(limit->left >> 20U) +
                                       " MiB are left."
                                 : "."});
    }
}

VulkanInstance::VulkanInstance(Nothing)
    : messages_(std::make_unique<std::atomic<int>>(0))
{}

// From here on the destructor runs even if a step fails.
VulkanInstance::VulkanInstance(const std::vector<const char*>& extensions)
    : VulkanInstance(Nothing())
{
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "glim";
    application.apiVersion = VK_API_VERSION_1_2;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;

    const VkValidationFeatureEnableEXT enabled[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(messages_.get());
    std::vector<const char*> enabledExtensions = extensions;
    // Without it loaders hide drivers that lack a part of Vulkan, as MoltenVK does. glim needs none of these parts.
    if (contains(instanceExtensions(), VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME)) {
        enabledExtensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
        info.flags |= VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR;
    }
    const bool validation = wantsValidation();
    if (validation) {
        requireValidationLayer();
        features.enabledValidationFeatureCount = 1;
        features.pEnabledValidationFeatures = enabled;
        messenger.pNext = &features;
        info.pNext = &messenger;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
        enabledExtensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    info.enabledExtensionCount = static_cast<std::uint32_t>(enabledExtensions.size());
    info.ppEnabledExtensionNames = enabledExtensions.data();
    check(vkCreateInstance(&info, nullptr, &handle_),
          "create an instance (is a driver installed? Debian has a software one in mesa-vulkan-drivers)");
    if (validation) {
        const auto create =
            reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(handle_, "vkCreateDebugUtilsMessengerEXT"));
        const VkDebugUtilsMessengerCreateInfoEXT own = messengerInfo(messages_.get());
        check(create(handle_, &own, nullptr, &messenger_), "create a debug messenger");
    }
}

VulkanInstance::~VulkanInstance()
{
    if (messenger_ != VK_NULL_HANDLE) {
        const auto destroy =
            reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(handle_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(handle_, messenger_, nullptr);
    }
    vkDestroyInstance(handle_, nullptr);
    if (*messages_ > 0) {
        std::_Exit(static_cast<int>(ExitCode::Device));  // a destructor cannot throw
    }
}

std::vector<VkPhysicalDevice> VulkanInstance::physicalDevices() const
{
    std::uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(handle_, &count, nullptr), "list devices");
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(handle_, &count, devices.data()), "list devices");
    return devices;
}

void VulkanInstance::refuseMessages() const
{
    if (*messages_ > 0) {
        throw DeviceError(MessageId::DriverFailed,
                          {"The Vulkan validation layers have complained (see above); glim accepts no message of theirs."});
    }
}

}  // namespace glim
