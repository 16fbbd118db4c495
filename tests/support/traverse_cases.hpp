// Rays and scenes for tests of traversal.
#pragma once

#include "host/flatten/split_triangles.hpp"
#include "shaders/shared/path_types.h"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <functional>
#include <limits>
#include <ostream>
#include <random>

namespace glim {

struct TraverseCase {
    PathRay ray;
    uint target = kNoPrimitive;
    float tMax = 1.0F;
};

class RayMaker {
public:
    explicit RayMaker(const SceneOnDevice& scene)
        : scene_(scene)
    {}

    // Anywhere, in any direction; every third with one or two direction components of +0 or -0, and then with its origin
    // exactly on planes of the boxes of primitives.
    TraverseCase anywhere(const std::vector<Box>& boxes)
    {
        TraverseCase c{};
        c.ray.source = kNoPrimitive;
        c.ray.origin = point(1.2F);
        c.ray.direction = glm::normalize(point(1.0F));
        if (random_() % 3 == 0) {
            const auto kept = static_cast<int>(random_() % 3);
            for (int k = 0; k < 3; ++k) {
                if (k != kept && (random_() % 2 == 0 || k == (kept + 1) % 3)) {
                    c.ray.direction[k] = random_() % 2 == 0 ? 0.0F : -0.0F;
                    const Box& box = boxes[below(boxes.size())];
                    c.ray.origin[k] = random_() % 2 == 0 ? box.lo[k] : box.hi[k];
                }
            }
            c.ray.direction = glm::normalize(c.ray.direction);
        }
        pickShadow(c);
        return c;
    }

    // Off the surface of a primitive, towards any side.
    TraverseCase leaving()
    {
        const Primitives& primitives = scene_.primitives;
        TraverseCase c = {};
        const std::uint32_t id = below(scene_.refOfPrimitive.size());
        c.ray.source = id;
        c.ray.direction = glm::normalize(point(1.0F));
        if (id < primitives.triangles.size()) {
            const Triangle& t = primitives.triangles[id];
            c.ray.origin = 0.5F * t.vertices[0] + 0.2F * t.vertices[1] + 0.3F * t.vertices[2];
        } else {
            const PlacedSphere& sphere = primitives.spheres[id - primitives.triangles.size()];
            c.ray.origin = sphere.center + sphere.radius * glm::normalize(point(1.0F));
        }
        pickShadow(c);
        return c;
    }

private:
    glm::vec3 point(float size)
    {
        std::uniform_real_distribution<float> within(-size, size);
        const float x = within(random_), y = within(random_);
        return {x, y, within(random_)};
    }

    void pickShadow(TraverseCase& c)
    {
        c.target = random_() % 2 == 0 ? below(scene_.refOfPrimitive.size()) : kNoPrimitive;
        c.tMax = random_() % 4 == 0 ? std::numeric_limits<float>::infinity() : std::uniform_real_distribution<float>(0.05F, 1.0F)(random_);
    }

    std::uint32_t below(std::size_t count) { return static_cast<std::uint32_t>(random_() % count); }

    const SceneOnDevice& scene_;
    std::mt19937 random_{7};
};

// The boxes that the scene's tree may be made of.
inline std::vector<Box> piecesOrPrimitives(const Primitives& primitives)
{
    Pieces pieces = splitTriangles(primitives.triangles, primitiveBoxes(primitives));
    return pieces.boxes.empty() ? primitiveBoxes(primitives) : std::move(pieces.boxes);
}

struct TraverseInput {
    const char* name;
    std::function<Scene()> make;
};

inline void PrintTo(const TraverseInput& input, std::ostream* out) { *out << input.name; }

inline std::vector<TraverseInput> traverseInputs()
{
    return {{"Mixed", [] { return makeTestScene(randomTriangles(250, 0.3F, 1), randomSpheres(50, 0.2F, 2)); }},
            {"Large", [] { return makeTestScene(randomTriangles(60, 1.5F, 3), randomSpheres(6, 1.2F, 4)); }},
            {"Spheres", [] { return makeTestScene({}, randomSpheres(200, 0.3F, 5)); }},
            {"Small", [] { return makeTestScene(randomTriangles(500, 0.1F, 6), randomSpheres(100, 0.1F, 7)); }},
            {"Strips", [] { return makeTestScene(placed(strips(12, 9), 0.5F, 0.0F), randomSpheres(20, 0.2F, 10)); }},
            {"OneTriangle", [] { return makeTestScene(randomTriangles(1, 1.5F, 8)); }},
            {"OneSphere", [] {
                 return makeTestScene({}, {{"", glm::vec3(0.1F, 0.2F, 0.0F), 0.8F, 0}});
             }}};
}

}  // namespace glim
