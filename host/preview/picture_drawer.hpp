// Draws what the window shows: a film, or what was denoised of it.
#pragma once

#include "host/preview/idle_denoiser.hpp"
#include "host/render/display.hpp"
#include "host/render/painter.hpp"

#include <cstdint>
#include <optional>

namespace glim {

class PictureDrawer {
public:
    explicit PictureDrawer(Device& device)
        : device_(device),
          display_(device)
    {}

    // Sets the picture's size. It is black until something is drawn.
    void resize(const glm::uvec2& size);
    glm::uvec2 size() const { return {display_.width(), display_.height()}; }

    // Kernels have changed.
    void renew();
    void draw(const Renderer& renderer, Aov aov, const DisplayRange& range, const Look& look);
    void draw(const IdleDenoiser::Result& denoised, const Look& look);
    // What was drawn last.
    const StorageImage& picture() const { return isDenoised_ ? painter_->picture() : display_.picture(); }

private:
    Device& device_;
    Display display_;
    std::optional<Painter> painter_;  // of denoised pictures
    std::uint64_t painted_ = 0;       // the version whose values painter_ has
    bool isDenoised_ = false;         // what was drawn last
};

}  // namespace glim
