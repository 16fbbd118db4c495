#include "host/gpu/swapchain.hpp"

#include <algorithm>
#include <iterator>

namespace glim {
namespace {

constexpr std::uint64_t kAcquireNanoseconds = 200'000'000;  // a compositor may withhold the images of a hidden window
constexpr std::uint32_t kNoImage = 0xffffffff;

VkSurfaceFormatKHR chooseFormat(const Device& device, VkSurfaceKHR surface)
{
    VkSurfaceCapabilitiesKHR capabilities;
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical(), surface, &capabilities), "look at the window");
    const bool takesBlits = (capabilities.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT) != 0;
    std::uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical(), surface, &count, nullptr), "list the window's formats");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical(), surface, &count, formats.data()), "list the window's formats");
    for (const VkSurfaceFormatKHR& format : formats) {
        VkFormatProperties properties;
        vkGetPhysicalDeviceFormatProperties(device.physical(), format.format, &properties);
        const bool plain = format.format == VK_FORMAT_B8G8R8A8_UNORM || format.format == VK_FORMAT_R8G8B8A8_UNORM;
        if (takesBlits && plain && (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_BLIT_DST_BIT) != 0) {
            return format;
        }
    }
    throw InputError(MessageId::NoWindow,
                     {"Device ", part::quoted(device.description().name), " shows no ", part::expected("plain 8-bit colours"),
                      " in this window; `glim render` writes the picture to a file instead."});
}

// In mailbox mode a new image replaces one that waits, so that presenting never blocks. Every device has FIFO mode.
VkPresentModeKHR chooseMode(const Device& device, VkSurfaceKHR surface)
{
    std::uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical(), surface, &count, nullptr), "list ways to present");
    std::vector<VkPresentModeKHR> modes(count);
    check(vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical(), surface, &count, modes.data()), "list ways to present");
    const bool mailbox = std::find(modes.begin(), modes.end(), VK_PRESENT_MODE_MAILBOX_KHR) != modes.end();
    return mailbox ? VK_PRESENT_MODE_MAILBOX_KHR : VK_PRESENT_MODE_FIFO_KHR;
}

VkExtent2D chooseExtent(const VkSurfaceCapabilitiesKHR& surface, std::uint32_t width, std::uint32_t height)
{
    if (surface.currentExtent.width != 0xffffffff) {
        return surface.currentExtent;
    }
    return {std::clamp(width, surface.minImageExtent.width, surface.maxImageExtent.width),
            std::clamp(height, surface.minImageExtent.height, surface.maxImageExtent.height)};
}

}  // namespace

Swapchain::Swapchain(Device& device, VkSurfaceKHR surface)
    : device_(device),
      surface_(surface),
      format_(chooseFormat(device, surface)),
      mode_(chooseMode(device, surface)),
      painter_(device, format_.format),
      handle_(device),
      acquired_(device)
{
    const VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(device.handle(), &info, nullptr, acquired_.receive()), "create a fence");
}

Swapchain::~Swapchain() { vkQueueWaitIdle(device_.queue()); }

// Returns false if the window has no area.
bool Swapchain::rebuild(std::uint32_t width, std::uint32_t height)
{
    VkSurfaceCapabilitiesKHR surface;
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_, &surface), "look at the window");
    extent_ = chooseExtent(surface, width, height);
    if (extent_.width == 0 || extent_.height == 0) {
        return false;
    }
    check(vkQueueWaitIdle(device_.queue()), "wait for the device");
    targets_.clear();
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface_;
    info.minImageCount = std::max(3U, surface.minImageCount + 1);
    if (surface.maxImageCount > 0) {
        info.minImageCount = std::min(info.minImageCount, surface.maxImageCount);
    }
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    info.preTransform = surface.currentTransform;
    info.compositeAlpha = (surface.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0 ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                                                                                     : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = mode_;
    info.clipped = VK_TRUE;
    info.oldSwapchain = handle_.get();
    Owned<VkSwapchainKHR, vkDestroySwapchainKHR> fresh(device_);
    const VkResult result = vkCreateSwapchainKHR(device_.handle(), &info, nullptr, fresh.receive());
    handle_ = std::move(fresh);
    check(result, "create a swapchain");
    getImages();
    stale_ = false;
    return true;
}

void Swapchain::getImages()
{
    std::uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(device_.handle(), handle_.get(), &count, nullptr), "list the swapchain's images");
    std::vector<VkImage> images(count);
    check(vkGetSwapchainImagesKHR(device_.handle(), handle_.get(), &count, images.data()), "list the swapchain's images");
    for (const VkImage image : images) {
        targets_.push_back(makeTarget(image));
    }
}

Swapchain::Target Swapchain::makeTarget(VkImage image) const
{
    Target target(device_, image);
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format_.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    check(vkCreateImageView(device_.handle(), &view, nullptr, target.view.receive()), "create a view of the window's image");
    VkFramebufferCreateInfo framebuffer{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
    framebuffer.renderPass = painter_.pass();
    framebuffer.attachmentCount = framebuffer.layers = 1;
    framebuffer.pAttachments = target.view.address();
    framebuffer.width = extent_.width;
    framebuffer.height = extent_.height;
    check(vkCreateFramebuffer(device_.handle(), &framebuffer, nullptr, target.framebuffer.receive()), "create a framebuffer");
    const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    check(vkCreateSemaphore(device_.handle(), &semaphore, nullptr, target.drawn.receive()), "create a semaphore");
    return target;
}

// The index of an image to draw to, or kNoImage.
std::uint32_t Swapchain::acquire()
{
    std::uint32_t image = kNoImage;
    const VkResult result =
        vkAcquireNextImageKHR(device_.handle(), handle_.get(), kAcquireNanoseconds, VK_NULL_HANDLE, acquired_.get(), &image);
    stale_ = result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR;
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_TIMEOUT || result == VK_NOT_READY) {
        return kNoImage;
    }
    check(result, "acquire an image of the window");
    check(vkWaitForFences(device_.handle(), 1, acquired_.address(), VK_TRUE, UINT64_MAX), "wait for an image of the window");
    check(vkResetFences(device_.handle(), 1, acquired_.address()), "reset a fence");
    return image;
}

bool Swapchain::present(const StorageImage& image, ImDrawData& panels, std::uint32_t width, std::uint32_t height)
{
    if (stale_ && !rebuild(width, height)) {
        return false;
    }
    const std::uint32_t index = acquire();
    if (index == kNoImage) {
        return false;
    }
    const Target& target = targets_[index];
    Commands commands(device_);
    commands.blit(image, target.image, extent_);
    painter_.draw(commands, target.framebuffer.get(), extent_, panels);
    commands.submitAndWait(target.drawn.get());

    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = target.drawn.address();
    info.swapchainCount = 1;
    info.pSwapchains = handle_.address();
    info.pImageIndices = &index;
    const VkResult result = vkQueuePresentKHR(device_.queue(), &info);
    stale_ = stale_ || result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR;
    if (result != VK_ERROR_OUT_OF_DATE_KHR) {
        check(result, "present an image");
    }
    device_.instance().refuseMessages();
    return result != VK_ERROR_OUT_OF_DATE_KHR;
}

}  // namespace glim
