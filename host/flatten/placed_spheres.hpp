// The spheres of a scene, and the points and lines of its clouds, as rays meet them.
#pragma once

#include "host/bvh/bvh.hpp"
#include "host/scene/placed_mesh.hpp"

#include <optional>
#include <ranges>

namespace glim {

// A sphere of the scene, or a point or a line of a cloud. A line is a sphere that moves along `axis`.
struct PlacedSphere {
    glm::vec3 center{0.0F};
    float radius = 1.0F;
    std::uint32_t material = 0;
    std::uint32_t object = 0;        // among the scene's instances and, behind these, its spheres
    std::uint32_t point = kNoIndex;  // of the instance's mesh; or its line
    glm::vec3 axis{0.0F};

    // What is shorter has no direction in float32.
    bool isLine() const { return glm::dot(axis, axis) > 1e-30F; }
};

// Rounded outwards.
Box computeBox(const PlacedSphere& sphere);

// An array that stores no points: they are placed whenever they are asked for, since a scene has many millions of them.
class PlacedSpheres {
public:
    PlacedSpheres() = default;
    explicit PlacedSpheres(std::vector<PlacedSphere> spheres)
        : own_(std::move(spheres))
    {}
    // Those of the scene, then the points or lines of clouds, one instance after the other.
    explicit PlacedSpheres(const Scene& scene);

    std::size_t size() const { return order_ ? order_->size() : count_ + own_.size(); }
    bool empty() const { return size() == 0; }
    PlacedSphere operator[](std::size_t i) const;
    auto all() const
    {
        return std::views::iota(std::size_t{0}, size()) | std::views::transform([this](std::size_t i) { return (*this)[i]; });
    }
    // White where a sphere has none; that of a line is the mean of its ends' colours.
    glm::vec4 computeColor(const PlacedSphere& sphere) const;

    // From here on, element i is what is element order[i] now.
    void select(std::vector<std::uint32_t> order);

private:
    struct Cloud {
        std::size_t first;  // of its points, among those of all clouds
        std::uint32_t instance, mesh;
        float radius;
        Placing place;
    };

    const Cloud& findCloud(std::size_t point) const;

    std::vector<PlacedSphere> own_;
    SharedVector<Mesh> meshes_;
    std::vector<Cloud> clouds_;  // by `first`
    std::size_t count_ = 0;      // of points and lines
    std::optional<std::vector<std::uint32_t>> order_;
};

}  // namespace glim
