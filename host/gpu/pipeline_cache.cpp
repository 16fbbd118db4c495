#include "host/gpu/pipeline_cache.hpp"

#include "host/text.hpp"

#include <exception>

namespace glim {
namespace {

std::string describeDriver(VkPhysicalDevice physical)
{
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver, {}};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    const VkPhysicalDeviceProperties& device = properties.properties;
    std::string key = format("vendor %u, device %u, driver %u, API %u, cache ", device.vendorID, device.deviceID, device.driverVersion,
                             device.apiVersion);
    for (const std::uint8_t byte : device.pipelineCacheUUID) {
        key += format("%02x", byte);
    }
    return key + ", " + device.deviceName + ", " + driver.driverName + " " + driver.driverInfo;
}

}  // namespace

PipelineCache::PipelineCache(VkPhysicalDevice physical, VkDevice device)
    : device_(device),
      file_(describeDriver(physical), ".kernels")
{
    const std::string cache = file_.read();
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    info.initialDataSize = cache.size();
    info.pInitialData = cache.data();
    if (vkCreatePipelineCache(device_, &info, nullptr, &handle_) != VK_SUCCESS) {
        handle_ = VK_NULL_HANDLE;
    }
    written_ = size();
}

PipelineCache::~PipelineCache()
{
    write();
    vkDestroyPipelineCache(device_, handle_, nullptr);
}

std::size_t PipelineCache::size() const
{
    std::size_t bytes = 0;
    return handle_ != VK_NULL_HANDLE && vkGetPipelineCacheData(device_, handle_, &bytes, nullptr) == VK_SUCCESS ? bytes : 0;
}

void PipelineCache::write() noexcept
{
    try {
        std::string cache(size(), '\0');
        std::size_t bytes = cache.size();
        if (file_.isKept() && bytes > written_ && vkGetPipelineCacheData(device_, handle_, &bytes, cache.data()) == VK_SUCCESS) {
            written_ = bytes;
            file_.write(std::string_view(cache).substr(0, bytes));
        }
    } catch (const std::exception&) {  // there is no memory for a copy
        return;
    }
}

}  // namespace glim
