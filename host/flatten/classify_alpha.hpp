// Whether a triangle is opaque or transparent all over.
#pragma once

#include "host/flatten/box_sums.hpp"

#include <map>

namespace glim {

enum class Coverage { Opaque, Transparent, Mixed };

class AlphaClassifier {
public:
    explicit AlphaClassifier(const Scene& scene)
        : scene_(scene)
    {}

    // `corners`: vertices of the mesh.
    Coverage classify(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners);
    Coverage classify(const Sphere& sphere) const;

private:
    struct Shares {
        BoxSums opaque, transparent;
    };
    const Shares& sharesOf(std::uint32_t material);

    const Scene& scene_;
    std::map<std::uint32_t, Shares> shares_;  // by material
};

}  // namespace glim
