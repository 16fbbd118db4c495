// Draws the panels of Dear ImGui over a window's image. Only these files use its Vulkan backend.
#pragma once

#include "host/gpu/commands.hpp"

struct ImDrawData;

namespace glim {

class PanelPainter {
public:
    // For images of this format. Uploads the fonts of ImGui's current context, which must outlive the painter.
    PanelPainter(const Device& device, VkFormat format);
    ~PanelPainter();
    PanelPainter(const PanelPainter&) = delete;
    PanelPainter& operator=(const PanelPainter&) = delete;

    // To be called when the context's fonts are others.
    void renewFonts();

    // For framebuffers with one colour attachment.
    VkRenderPass pass() const { return pass_.get(); }
    // The framebuffer's image goes from the layout of a colour attachment to that for presenting.
    void draw(Commands& commands, VkFramebuffer framebuffer, VkExtent2D size, ImDrawData& panels) const;

private:
    class Backend;  // ImGui's
    void open();

    const Device& device_;
    Owned<VkRenderPass, vkDestroyRenderPass> pass_;
    Owned<VkDescriptorPool, vkDestroyDescriptorPool> pool_;
    std::unique_ptr<Backend> backend_;
};

}  // namespace glim
