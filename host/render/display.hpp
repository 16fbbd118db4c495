// What a window shows of a film: the kernels preview and overlay.
#pragma once

#include "host/gpu/commands.hpp"
#include "host/image/text.hpp"
#include "host/render/look.hpp"
#include "host/render/renderer.hpp"
#include "shaders/shared/display_types.h"

#include <optional>
#include <vector>

namespace glim {

class Display {
public:
    explicit Display(Device& device);

    // Of this size from now on, black until something is drawn.
    void resize(std::uint32_t width, std::uint32_t height);

    // Draws what `renderer` has, stretched over the picture; `exposure` in stops, of radiance and albedo.
    void draw(const Renderer& renderer, Look look, const LookRange& range, double exposure);
    // Puts text over what is drawn.
    void cover(const TextBox& text);
    // What is to be shown, after cover.
    const StorageImage& shown() const { return *shown_; }
    std::uint32_t width() const { return shown_->width(); }
    std::uint32_t height() const { return shown_->height(); }

private:
    void run(const Kernel& kernel, const Bindings& bindings, const DisplayPass& pass, std::uint64_t threads);
    const Kernel& previewOf(Look look, bool folded);
    void takeFolded(const Renderer& renderer);

    Device& device_;
    KernelLayout layout_;
    Kernel overlay_;
    std::map<std::pair<Look, bool>, Kernel> previews_;  // by look, and whether pages are folded; compiled when needed
    std::optional<StorageImage> picture_, shown_;
    std::unique_ptr<Buffer> text_;
    std::vector<std::unique_ptr<Buffer>> folded_;  // one per slab of the renderer's film
    std::uint64_t foldVersion_ = 0;                // of folded_
};

}  // namespace glim
