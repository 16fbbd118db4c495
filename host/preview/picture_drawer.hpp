// Draws what the window shows: a film, what was denoised of it, or its error.
#pragma once

#include "host/preview/error_layer.hpp"
#include "host/preview/idle_denoiser.hpp"
#include "host/render/display.hpp"
#include "host/render/painter.hpp"

#include <cstdint>
#include <optional>
#include <span>

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
    // Whether a checkerboard shows where no surface is.
    void setTransparent(bool transparent) { isTransparent_ = transparent; }
    void draw(Renderer& renderer, Aov aov, const DisplayRange& range, const Look& look);
    void draw(Renderer& renderer, const IdleDenoiser::Result& denoised, const Look& look);
    // Until errors are known, the film in grey.
    void draw(Renderer& renderer, const ErrorLayer& errors, const Look& look);
    // What was drawn last.
    const StorageImage& picture() const { return isPainted_ ? painter_->picture() : display_.picture(); }

private:
    enum class Painted { Nothing, Denoised, Errors };
    bool beginPainting(Painted what, std::uint64_t version);
    void paint(ViewPass pass);

    Device& device_;
    bool isTransparent_ = false;
    Display display_;
    std::optional<Painter> painter_;  // of values that are on the host
    Painted painted_ = Painted::Nothing;
    std::uint64_t version_ = 0;  // of what is painted, whose values painter_ has
    bool isPainted_ = false;     // what was drawn last
};

}  // namespace glim
