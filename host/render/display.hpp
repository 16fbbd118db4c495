// Draws a film for a window, with the kernel preview.
#pragma once

#include "host/gpu/commands.hpp"
#include "host/render/aov.hpp"
#include "host/render/renderer.hpp"
#include "shaders/shared/display_types.h"

#include <optional>
#include <vector>

namespace glim {

class Display {
public:
    explicit Display(Device& device);

    // Sets the picture's size. It is black until something is drawn.
    void resize(std::uint32_t width, std::uint32_t height);

    // Draws the renderer's film so far, stretched over the picture.
    void draw(const Renderer& renderer, Aov aov, const DisplayRange& range, const Look& look);
    const StorageImage& picture() const { return *picture_; }
    std::uint32_t width() const { return picture_->width(); }
    std::uint32_t height() const { return picture_->height(); }

private:
    void run(const Kernel& kernel, const Bindings& bindings, const DisplayPass& pass, std::uint64_t threads);
    const Kernel& getPreview(Aov aov, bool folded);
    void takeFolded(const Renderer& renderer);

    Device& device_;
    KernelLayout layout_;
    std::map<std::pair<Aov, bool>, Kernel> previews_;  // by aov, and whether pages are folded; compiled when needed
    std::optional<StorageImage> picture_;
    std::vector<std::unique_ptr<Buffer>> folded_;  // one per tile of the renderer's film
    std::uint64_t foldVersion_ = 0;                // the version that folded_ holds
};

}  // namespace glim
