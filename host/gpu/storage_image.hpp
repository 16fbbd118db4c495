// An image that kernels write: RGBA with 8 bits a channel, numbers from 0 to 1 without a transfer function.
#pragma once

#include "host/gpu/owned.hpp"

namespace glim {

class StorageImage {
public:
    // The image is black at first. Throws DeviceError if the device cannot hold it.
    StorageImage(Device& device, const std::string& name, std::uint32_t width, std::uint32_t height);

    VkImage handle() const { return handle_.get(); }
    VkImageView view() const { return view_.get(); }
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }

private:
    void allocate(const std::string& name);

    Device& device_;
    std::uint32_t width_, height_;
    OwnedMemory memory_;  // outlives the image
    Owned<VkImage, vkDestroyImage> handle_;
    Owned<VkImageView, vkDestroyImageView> view_;
};

}  // namespace glim
