// The compiled kernels of a device, kept on disk from one run to the next. Each driver has a file of its own. The kernels that the last run
// of several at a time did not have are compiled and added by the next that needs them. A driver whose own kernels are more than a file may
// be begins with none again.
#pragma once

#include "host/gpu/cache_file.hpp"

#include <vulkan/vulkan.h>

#include <cstddef>

namespace glim {

class PipelineCache {
public:
    PipelineCache(VkPhysicalDevice physical, VkDevice device);
    // Writes what is new.
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return handle_; }

    // Writes the file if kernels have been added since it was read or written.
    void write() noexcept;

private:
    std::size_t size() const;

    VkDevice device_;
    CacheFile file_;
    VkPipelineCache handle_ = VK_NULL_HANDLE;  // none if the driver could not make one
    std::size_t written_ = 0;                  // bytes that need not be written: what the driver made of the file, or an empty cache
};

}  // namespace glim
