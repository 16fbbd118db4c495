// Tells whether a triangle or a sphere is opaque or transparent all over.
#pragma once

#include "host/flatten/box_sums.hpp"

#include <map>
#include <tuple>

namespace glim {

enum class Coverage { Opaque, Transparent, Mixed };

class AlphaClassifier {
public:
    explicit AlphaClassifier(const Scene& scene)
        : scene_(scene)
    {}

    // `corners`: vertices of the mesh.
    Coverage classify(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners);
    // Of a sphere whose colour has the alpha `vertexAlpha` all over.
    Coverage classify(std::uint32_t material, float vertexAlpha = 1.0F) const;

private:
    struct Shares {
        BoxSums opaque, transparent;
    };
    const Shares& findShares(const Material& material);

    // What a texel's coverage depends on: image, mode, cutoff and factor. Sums are as large as images, and materials may share one.
    using Rule = std::tuple<std::uint32_t, AlphaMode, float, float>;

    const Scene& scene_;
    std::map<Rule, Shares> shares_;
};

}  // namespace glim
