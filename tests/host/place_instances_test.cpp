// The bounds of what float32 transforms round, against double.
#include "host/flatten/place_instances.hpp"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace glim {
namespace {

class Randoms {
public:
    double within(double extent) { return extent * std::uniform_real_distribution<double>(-1.0, 1.0)(engine_); }
    glm::dvec3 vector(double extent) { return {within(extent), within(extent), within(extent)}; }
    // Scaled by 1e-2 to 1e2 along each axis, turned, sometimes mirrored, up to `away` metres away.
    Placement placement(double away)
    {
        const glm::dvec3 scale(std::pow(10.0, within(2.0)), std::pow(10.0, within(2.0)), std::pow(10.0, within(2.0)));
        const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), within(3.0), glm::normalize(vector(1.0)));
        return {0, 0, glm::dmat3(glm::scale(turned, within(1.0) < 0.0 ? -scale : scale)), vector(away)};
    }

private:
    std::mt19937 engine_{7};
};

// As the kernels compute it, without fused operations.
glm::vec3 toMesh(const std::array<glm::vec4, 3>& rows, const glm::vec3& v, float w)
{
    glm::vec3 out;
    for (int k = 0; k < 3; ++k) {
        const glm::vec4& row = rows[static_cast<std::size_t>(k)];
        out[k] = ((row.x * v.x + row.y * v.y) + row.z * v.z) + row.w * w;
    }
    return out;
}

glm::vec3 toScene(const InstanceData& data, const glm::vec3& p)
{
    return ((data.column0 * p.x + data.column1 * p.y) + data.column2 * p.z) + data.translation;
}

// The largest component of the error, in bounds.
double shareOf(const glm::dvec3& error, const glm::vec3& bound)
{
    const glm::dvec3 share = glm::abs(error) / glm::dvec3(bound);
    return std::max({share.x, share.y, share.z});
}

TEST(PlaceInstances, RaysPassNoFartherBesideTheirPlaceThanTheBound)
{
    Randoms random;
    double worst = 0.0;
    for (const double away : {1.0, 1e3, 1e5}) {
        for (int i = 0; i < 100'000; ++i) {
            const Placement placement = random.placement(away);
            const auto rows = meshFromScene(placement);
            const glm::vec3 origin(random.vector(away)), way(random.vector(2.0 * away));
            const glm::dvec3 inMesh = glm::dvec3(toMesh(rows, origin, 1.0F)) + glm::dvec3(toMesh(rows, way, 0.0F));
            const glm::dvec3 back = placement.linear * inMesh + placement.translation;
            const double share =
                shareOf(back - (glm::dvec3(origin) + glm::dvec3(way)), boundRayError(placement, glm::vec3(glm::dvec3(away))));
            worst = std::max(worst, share);
        }
    }
    std::printf("at most %.2f of the bound\n", worst);
    EXPECT_LE(worst, 1.0);
    EXPECT_GT(worst, 0.1) << "the bound is too wide to test anything";
}

TEST(PlaceInstances, PointsRoundNoMoreThanTheirBound)
{
    Randoms random;
    double worst = 0.0;
    for (const double away : {1.0, 1e3, 1e5}) {
        for (int i = 0; i < 100'000; ++i) {
            const Placement placement = random.placement(away);
            const InstanceData data = placeInstance(placement, {glm::vec3(-1.0F), glm::vec3(1.0F)});
            const glm::vec3 point(random.vector(1.0));
            const glm::vec3 placed = toScene(data, point);
            // Where the mesh's own tests will find the placed point again, seen from the scene.
            const glm::dvec3 again = placement.linear * glm::dvec3(toMesh(meshFromScene(placement), placed, 1.0F)) + placement.translation;
            const glm::dvec3 truth = placement.linear * glm::dvec3(point) + placement.translation;
            worst = std::max({worst, shareOf(again - truth, data.errorBound), shareOf(glm::dvec3(placed) - truth, data.errorBound)});
        }
    }
    std::printf("at most %.2f of the bound\n", worst);
    EXPECT_LE(worst, 1.0);
    EXPECT_GT(worst, 0.1) << "the bound is too wide to test anything";
}

TEST(PlaceInstances, BoxesHoldWhatIsPlaced)
{
    Randoms random;
    for (int i = 0; i < 20'000; ++i) {
        const Placement placement = random.placement(100.0);
        const glm::vec3 low(random.vector(1.0)), high = low + glm::abs(glm::vec3(random.vector(1.0)));
        const std::vector<Box> parts{{low, high}};
        const Box box = placeBoxes(placement, parts);
        glm::dvec3 least(1e30), most(-1e30);
        for (unsigned corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p((corner & 1U) != 0 ? high.x : low.x, (corner & 2U) != 0 ? high.y : low.y,
                               (corner & 4U) != 0 ? high.z : low.z);
            least = glm::min(least, placement.linear * p + placement.translation);
            most = glm::max(most, placement.linear * p + placement.translation);
        }
        for (int k = 0; k < 3; ++k) {
            EXPECT_LE(static_cast<double>(box.lo[k]), least[k] + 1e-12);
            EXPECT_GE(static_cast<double>(box.hi[k]), most[k] - 1e-12);
            EXPECT_NEAR(static_cast<double>(box.lo[k]), least[k], 1e-4);
            EXPECT_NEAR(static_cast<double>(box.hi[k]), most[k], 1e-4);
        }
    }
}

}  // namespace
}  // namespace glim
