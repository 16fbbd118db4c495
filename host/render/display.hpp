// Draws a film for a window, with the kernel preview.
#pragma once

#include "host/gpu/commands.hpp"
#include "host/render/aov.hpp"
#include "host/render/renderer.hpp"
#include "shaders/shared/display_types.h"

#include <compare>
#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace glim {

class Display {
public:
    explicit Display(Device& device);

    // Sets the size of the window's picture, and which part of it shows the film: from `low` to `high`, without `high`. It is black until
    // something is drawn.
    void resize(const glm::uvec2& window, const glm::uvec2& low, const glm::uvec2& high);
    // Kernels have changed.
    void renew() { kernels_.clear(); }

    // Draws the renderer's film so far, stretched over its part of the picture; of a larger film the means. Its light is composited if it
    // has shadow catchers. `drawn`: kDrawnInColor ... (shaders/shared/display_types.h). Means of many pixels take a while, and end earlier
    // once `shouldContinue` returns false: the earlier drawing stays where it has not come. Returns whether all is drawn.
    bool draw(const Renderer& renderer, Aov aov, const DisplayRange& range, const Look& look, std::uint32_t drawn,
              const std::function<bool()>& shouldContinue);
    const StorageImage& picture() const { return *picture_; }

private:
    // What the host has folded of a tile of the renderer's film.
    struct FoldedTile {
        Buffer pixels;
        std::optional<Buffer> catchers;
    };
    struct Shader {
        Aov aov;
        bool folded, composites, means;
        auto operator<=>(const Shader&) const = default;
    };

    void run(const Kernel& kernel, const Bindings& bindings, const DisplayPass& pass, std::uint64_t threads);
    const Kernel& getKernel(const Shader& shader);
    void takeFolded(const Renderer& renderer);

    Device& device_;
    KernelLayout layout_;
    std::map<Shader, Kernel> kernels_;  // compiled when needed
    std::optional<StorageImage> picture_;
    glm::uvec2 low_{0}, size_{0};  // of the part that shows the film
    std::vector<FoldedTile> folded_;
    std::uint64_t foldVersion_ = 0;  // the version that folded_ holds
};

}  // namespace glim
