// Draws a film for a window, with the kernel preview.
#pragma once

#include "host/gpu/commands.hpp"
#include "host/render/aov.hpp"
#include "host/render/renderer.hpp"
#include "shaders/shared/display_types.h"

#include <map>
#include <optional>
#include <tuple>
#include <vector>

namespace glim {

class Display {
public:
    explicit Display(Device& device);

    // Sets the picture's size. It is black until something is drawn.
    void resize(std::uint32_t width, std::uint32_t height);
    // Kernels have changed.
    void renew() { previews_.clear(); }

    // Draws the renderer's film so far, stretched over the picture. Its light is composited if it has shadow catchers. `drawn`:
    // kDrawnInColor ... (shaders/shared/display_types.h).
    void draw(const Renderer& renderer, Aov aov, const DisplayRange& range, const Look& look, std::uint32_t drawn = kDrawnInColor);
    const StorageImage& picture() const { return *picture_; }
    std::uint32_t width() const { return picture_->width(); }
    std::uint32_t height() const { return picture_->height(); }

private:
    // What the host has folded of a tile of the renderer's film.
    struct FoldedTile {
        Buffer pixels;
        std::optional<Buffer> catchers;
    };

    void run(const Kernel& kernel, const Bindings& bindings, const DisplayPass& pass, std::uint64_t threads);
    const Kernel& getPreview(Aov aov, bool folded, bool composites);
    void takeFolded(const Renderer& renderer);

    Device& device_;
    KernelLayout layout_;
    std::map<std::tuple<Aov, bool, bool>, Kernel> previews_;  // by the arguments of getPreview(); compiled when needed
    std::optional<StorageImage> picture_;
    std::vector<FoldedTile> folded_;
    std::uint64_t foldVersion_ = 0;  // the version that folded_ holds
};

}  // namespace glim
