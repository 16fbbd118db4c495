// A window's surface and the images that it shows in turn.
#pragma once

#include "host/gpu/storage_image.hpp"

namespace glim {

class Surface {
public:
    // Owns `handle`, which belongs to `instance`.
    Surface(const VulkanInstance& instance, VkSurfaceKHR handle)
        : instance_(instance),
          handle_(handle)
    {}
    ~Surface() { vkDestroySurfaceKHR(instance_.handle(), handle_, nullptr); }
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    VkSurfaceKHR handle() const { return handle_; }

private:
    const VulkanInstance& instance_;
    VkSurfaceKHR handle_;
};

// One thread owns it together with the device's queue.
class Swapchain {
public:
    // `surface` outlives the swapchain, and `device` was chosen for it. Throws InputError if the surface has no 8-bit format
    // without a transfer function (another would encode colours twice), or if images cannot be blitted to it.
    Swapchain(Device& device, VkSurfaceKHR surface);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    // Scales `image` to the window and shows it. `width` and `height` are the window's size in pixels, for surfaces that do not know
    // it. Returns false if nothing was shown because the window has no area or is changing; the caller may try again later.
    bool present(const StorageImage& image, std::uint32_t width, std::uint32_t height);

private:
    bool rebuild(std::uint32_t width, std::uint32_t height);
    void destroyImages();
    void getImages();
    std::uint32_t acquire();

    Device& device_;
    VkSurfaceKHR surface_;
    VkSurfaceFormatKHR format_;
    VkPresentModeKHR mode_;
    VkExtent2D extent_{0, 0};  // the size of the images; 0: there are none
    bool stale_ = true;        // the images no longer fit the surface
    VkSwapchainKHR handle_ = VK_NULL_HANDLE;
    VkFence acquired_ = VK_NULL_HANDLE;
    std::vector<VkImage> images_;
    std::vector<VkSemaphore> drawn_;  // one per image, signalled when it may be presented
};

}  // namespace glim
