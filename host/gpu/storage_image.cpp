#include "host/gpu/storage_image.hpp"

#include "host/gpu/commands.hpp"

namespace glim {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;  // storage and blit source on every Vulkan device

}  // namespace

StorageImage::StorageImage(Device& device, const std::string& name, std::uint32_t width, std::uint32_t height)
    : device_(device),
      width_(width),
      height_(height),
      memory_(device),
      handle_(device),
      view_(device)
{
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(device.physical(), &properties);
    const std::uint32_t most = properties.limits.maxImageDimension2D;
    if (width > most || height > most) {
        throw DeviceError(
            MessageId::DeviceLimit,
            {part::place(name), " would have ", part::value(std::to_string(width) + "x" + std::to_string(height)), " pixels, and \"",
             device.description().name, "\" has ", part::expected("at most " + std::to_string(most)), " a side."});
    }
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = kFormat;
    info.extent = {width, height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    check(vkCreateImage(device.handle(), &info, nullptr, handle_.receive()),
          "create " + name + " of " + std::to_string(width) + "x" + std::to_string(height) + " pixels");
    allocate(name);

    VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    viewInfo.image = handle_.get();
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = kFormat;
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    check(vkCreateImageView(device.handle(), &viewInfo, nullptr, view_.receive()), "create a view of " + name);
    device.setName(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(handle_.get()), name);

    Commands commands(device);
    commands.clear(*this);
    commands.submitAndWait();
}

void StorageImage::allocate(const std::string& name)
{
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device_.handle(), handle_.get(), &needs);
    VkMemoryPropertyFlags chosen = 0;
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = needs.size;
    info.memoryTypeIndex = device_.findMemoryType(needs.memoryTypeBits, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, &chosen);
    check(memory_.allocate(info), "allocate " + std::to_string(needs.size) + " bytes for " + name);
    check(vkBindImageMemory(device_.handle(), handle_.get(), memory_.get(), 0), "bind memory of " + name);
}

}  // namespace glim
