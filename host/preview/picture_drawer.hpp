// Draws what the window shows: a film, what was denoised of it, or its error.
#pragma once

#include "host/preview/error_layer.hpp"
#include "host/preview/idle_denoiser.hpp"
#include "host/render/display.hpp"
#include "host/render/painter.hpp"
#include "host/window/viewport.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace glim {

class PictureDrawer {
public:
    explicit PictureDrawer(Device& device)
        : device_(device),
          display_(device)
    {}

    // Sets the sizes of the picture and of the window, in whose middle the picture lies. The window is black until something is drawn.
    void resize(const glm::uvec2& picture, const glm::uvec2& window);
    glm::uvec2 size() const { return size_; }  // of the picture
    glm::uvec2 windowSize() const { return {display_.picture().width(), display_.picture().height()}; }
    const Viewport& viewport() const { return viewport_; }
    // How much smaller than the picture, a power of two, a film must at least be to have no more pixels than the window shows of it.
    std::uint32_t windowScale() const;

    // Kernels have changed.
    void renew();
    // Whether a checkerboard shows where no surface is.
    void setTransparent(bool transparent) { isTransparent_ = transparent; }
    // Returns whether all is drawn. Of a film with more pixels than the window shows, `shouldContinue` may end it earlier.
    bool draw(Renderer& renderer, Aov aov, const DisplayRange& range, const Look& look, const std::function<bool()>& shouldContinue);
    void draw(Renderer& renderer, const IdleDenoiser::Result& denoised, const Look& look);
    // Until errors are known, the film in grey, and then as above.
    bool draw(Renderer& renderer, const ErrorLayer& errors, const Look& look, const std::function<bool()>& shouldContinue);
    // The window's picture, as it was drawn last.
    const StorageImage& picture() const { return isPainted_ ? painter_->picture() : display_.picture(); }

    // The part of the window that shows the picture.
    Rectangle shown() const { return coveredBy(viewport_, size_, windowSize()); }

private:
    enum class Painted { Nothing, Denoised, Errors };
    bool beginPainting(Painted what, std::uint64_t version);
    const std::vector<glm::vec3>& layUnder(std::span<const glm::vec3> values);
    void paint(ViewPass pass);

    Device& device_;
    bool isTransparent_ = false;
    Display display_;
    glm::uvec2 size_{1};
    Viewport viewport_;
    std::optional<Painter> painter_;  // of values that are on the host
    Painted painted_ = Painted::Nothing;
    std::uint64_t version_ = 0;      // of what is painted, whose values painter_ has
    std::vector<glm::vec3> values_;  // the same under the window's pixels
    bool isPainted_ = false;         // what was drawn last
};

}  // namespace glim
