#include "host/gpu/panel_painter.hpp"

#include <backends/imgui_impl_vulkan.h>

namespace glim {
namespace {

constexpr std::uint32_t kImages = 2;  // the least that the backend takes; every submission is waited for

Owned<VkRenderPass, vkDestroyRenderPass> createPass(const Device& device, VkFormat format)
{
    VkAttachmentDescription image{};
    image.format = format;
    image.samples = VK_SAMPLE_COUNT_1_BIT;
    image.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    image.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    image.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    image.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    image.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    image.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    info.attachmentCount = info.subpassCount = 1;
    info.pAttachments = &image;
    info.pSubpasses = &subpass;
    Owned<VkRenderPass, vkDestroyRenderPass> pass(device);
    check(vkCreateRenderPass(device.handle(), &info, nullptr, pass.receive()), "create a render pass");
    return pass;
}

Owned<VkDescriptorPool, vkDestroyDescriptorPool> createPool(const Device& device)
{
    const VkDescriptorPoolSize fonts{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    info.maxSets = info.poolSizeCount = 1;
    info.pPoolSizes = &fonts;
    Owned<VkDescriptorPool, vkDestroyDescriptorPool> pool(device);
    check(vkCreateDescriptorPool(device.handle(), &info, nullptr, pool.receive()), "create a descriptor pool");
    return pool;
}

}  // namespace

class PanelPainter::Backend {
public:
    Backend(ImGui_ImplVulkan_InitInfo& info, VkRenderPass pass) { ImGui_ImplVulkan_Init(&info, pass); }
    ~Backend() { ImGui_ImplVulkan_Shutdown(); }
    Backend(const Backend&) = delete;
    Backend& operator=(const Backend&) = delete;
};

PanelPainter::PanelPainter(const Device& device, VkFormat format)
    : device_(device),
      pass_(createPass(device, format)),
      pool_(device)
{
    open();
}

PanelPainter::~PanelPainter() = default;

void PanelPainter::renewFonts()
{
    backend_.reset();
    open();
}

void PanelPainter::open()
{
    const Device& device = device_;
    pool_ = createPool(device);
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = device.instance().handle();
    info.PhysicalDevice = device.physical();
    info.Device = device.handle();
    info.QueueFamily = device.queueFamily();
    info.Queue = device.queue();
    info.DescriptorPool = pool_.get();
    info.MinImageCount = info.ImageCount = kImages;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = [](VkResult result) { check(result, "draw the window's panels"); };
    backend_ = std::make_unique<Backend>(info, pass_.get());
#if IMGUI_VERSION_NUM >= 19000  // Debian 13
    ImGui_ImplVulkan_CreateFontsTexture();
#else
    Commands commands(device);
    commands.record([](VkCommandBuffer buffer) { ImGui_ImplVulkan_CreateFontsTexture(buffer); });
    commands.submitAndWait();
    ImGui_ImplVulkan_DestroyFontUploadObjects();
#endif
}

void PanelPainter::draw(Commands& commands, VkFramebuffer framebuffer, VkExtent2D size, ImDrawData& panels) const
{
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass_.get();
    begin.framebuffer = framebuffer;
    begin.renderArea.extent = size;
    commands.record([&](VkCommandBuffer buffer) {
        vkCmdBeginRenderPass(buffer, &begin, VK_SUBPASS_CONTENTS_INLINE);
        ImGui_ImplVulkan_RenderDrawData(&panels, buffer);
        vkCmdEndRenderPass(buffer);
    });
}

}  // namespace glim
