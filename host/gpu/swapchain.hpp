// The pictures that a window shows in turn. One thread owns it, with the device's queue.
#pragma once

#include "host/gpu/storage_image.hpp"

namespace glim {

class Swapchain {
public:
    // `surface`: of a window that outlives this, and that the device was opened for. Throws InputError if it takes no 8-bit colours
    // without a transfer function of its own (which would encode them twice), or cannot be blitted to.
    Swapchain(Device& device, VkSurfaceKHR surface);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    // Shows `image`, stretched over a window of `width` x `height` pixels (where the surface does not know its size itself). False
    // if nothing was shown, because the window has no area or is changing: worth trying again later.
    bool present(const StorageImage& image, std::uint32_t width, std::uint32_t height);

private:
    bool rebuild(std::uint32_t width, std::uint32_t height);
    void destroyPictures();
    void takePictures();
    std::uint32_t acquire();

    Device& device_;
    VkSurfaceKHR surface_;
    VkSurfaceFormatKHR format_;
    VkPresentModeKHR mode_;
    VkExtent2D extent_{0, 0};    // of the pictures; 0: there are none
    bool stale_ = true;          // does not fit the surface any more
    VkSwapchainKHR handle_ = VK_NULL_HANDLE;
    VkFence acquired_ = VK_NULL_HANDLE;
    std::vector<VkImage> pictures_;
    std::vector<VkSemaphore> drawn_;  // one per picture
};

}  // namespace glim
