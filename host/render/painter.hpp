// Draws the window's picture, with the kernel view.
#pragma once

#include "host/gpu/commands.hpp"
#include "shaders/shared/display_types.h"

#include <glm/glm.hpp>

#include <optional>
#include <span>
#include <vector>

namespace glim {

class Painter {
public:
    explicit Painter(Device& device);

    // Sets the picture's size, at least 1x1. It is black until something is drawn.
    void resize(const glm::uvec2& size);
    glm::uvec2 size() const { return {picture_->width(), picture_->height()}; }
    const StorageImage& picture() const { return *picture_; }

    // The values under the picture's pixels, as many as there are: of the film, and of the reference that differences are from or the
    // alpha of surfaces.
    void setValues(std::span<const glm::vec3> values);
    void setReference(std::span<const glm::vec3> values);
    // Draws by `pass`, after it has set the band.
    void draw(ViewPass pass);

private:
    // Rows of the picture. A large window has more values than a device allows in one buffer.
    struct Band {
        std::uint32_t firstRow, rows;
        Buffer values, reference;
    };

    std::span<const glm::vec3> partOf(std::span<const glm::vec3> values, const Band& band) const;

    Device& device_;
    KernelLayout layout_;
    Kernel kernel_;
    std::optional<StorageImage> picture_;
    std::vector<Band> bands_;
};

}  // namespace glim
