// An image that kernels write: RGBA with 8 bits a channel, numbers from 0 to 1 without a transfer function.
#pragma once

#include "host/gpu/device.hpp"

namespace glim {

class StorageImage {
public:
    // The image is black at first. Throws DeviceError if the device cannot hold it.
    StorageImage(Device& device, const std::string& name, std::uint32_t width, std::uint32_t height);
    ~StorageImage();
    StorageImage(const StorageImage&) = delete;
    StorageImage& operator=(const StorageImage&) = delete;

    VkImage handle() const { return handle_; }
    VkImageView view() const { return view_; }
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }

private:
    void allocate(const std::string& name);

    Device& device_;
    std::uint32_t width_, height_;
    VkImage handle_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    std::uint64_t allocated_ = 0;
};

}  // namespace glim
