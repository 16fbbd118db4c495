// A window's surface and the images that it shows in turn.
#pragma once

#include "host/gpu/panel_painter.hpp"

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
    // `surface` and ImGui's current context outlive the swapchain, and `device` was chosen for the surface. Throws InputError if
    // the surface has no 8-bit format without a transfer function (another would encode colours twice), or if images cannot be
    // blitted to it.
    Swapchain(Device& device, VkSurfaceKHR surface);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    // To be called when the fonts of ImGui's context are others.
    void renewFonts() { painter_.renewFonts(); }

    // Scales `image` to the window and shows it with `panels` over it. `width` and `height` are the window's size in pixels, for surfaces
    // that do not know it. Returns false if nothing was shown because the window has no area or is changing; the caller may try again
    // later.
    bool present(const StorageImage& image, ImDrawData& panels, std::uint32_t width, std::uint32_t height);

private:
    struct Target {
        Target(const Device& device, VkImage ofSwapchain)
            : image(ofSwapchain),
              view(device),
              framebuffer(device),
              drawn(device)
        {}

        VkImage image;  // of the swapchain
        Owned<VkImageView, vkDestroyImageView> view;
        Owned<VkFramebuffer, vkDestroyFramebuffer> framebuffer;
        Owned<VkSemaphore, vkDestroySemaphore> drawn;  // signalled when the image may be presented
    };
    bool rebuild(std::uint32_t width, std::uint32_t height);
    void getImages();
    Target makeTarget(VkImage image) const;
    std::uint32_t acquire();

    Device& device_;
    VkSurfaceKHR surface_;
    VkSurfaceFormatKHR format_;
    VkPresentModeKHR mode_;
    PanelPainter painter_;
    VkExtent2D extent_{0, 0};  // the size of the images; 0: there are none
    bool stale_ = true;        // the images no longer fit the surface
    Owned<VkSwapchainKHR, vkDestroySwapchainKHR> handle_;
    Owned<VkFence, vkDestroyFence> acquired_;
    std::vector<Target> targets_;
};

}  // namespace glim
