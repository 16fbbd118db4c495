// Morphed and skinned meshes against numbers on paper.
#include "host/scene/deform_mesh.hpp"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace glim::test {
namespace {

constexpr double kTolerance = 1e-15;

void expectNear(const glm::dvec3& value, const glm::dvec3& expected, double tolerance = kTolerance)
{
    EXPECT_LT(glm::length(value - expected), tolerance) << value.x << ' ' << value.y << ' ' << value.z;
}

Mesh triangle()
{
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2};
    return mesh;
}

Influences follow(const std::vector<std::uint32_t>& joints) { return {1, joints, std::vector<double>(joints.size(), 1.0)}; }

TEST(DeformMesh, MorphTargetsAddUp)
{
    Mesh mesh = triangle();
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    mesh.tangents = {{1, 0, 0, -1}, {1, 0, 0, -1}, {1, 0, 0, -1}};
    const std::vector<glm::dvec3> none(3, glm::dvec3(0.0));
    MorphTarget up{2.0, {{0, 0, 1}, {0, 0, 0}, {0, 0, 3}}, {{0, 0.5, 0}, {0, 0, 0}, {0, 0, 0}}, {{0, 0.5, 0}, {0, 0, 0}, {0, 0, 0}}};
    MorphTarget back{-0.5, {{4, 0, 0}, {4, 0, 0}, {4, 0, 0}}, {}, {}};
    morphMesh(mesh, std::vector<MorphTarget>{up, back});
    expectNear(mesh.positions[0], {-2, 0, 2});
    expectNear(mesh.positions[1], {-1, 0, 0});
    expectNear(mesh.positions[2], {-2, 1, 6});
    const double half = std::sqrt(0.5);
    expectNear(mesh.normals[0], {0, half, half});
    expectNear(mesh.normals[1], {0, 0, 1});
    expectNear(glm::dvec3(mesh.tangents[0]), {half, half, 0}, 1e-7);
    EXPECT_EQ(mesh.tangents[0].w, -1.0F);
}

TEST(DeformMesh, MorphTargetsGiveNoNormals)
{
    Mesh mesh = triangle();
    morphMesh(mesh, std::vector<MorphTarget>{{1.0, {}, {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}}, {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}}}});
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.tangents.empty());
    expectNear(mesh.positions[1], {1, 0, 0});
}

// Joints that scale by (2, 1, 1) and (4, 1, 1), half each: by (3, 1, 1). The plane with the normal (1, 1, 0) gets (1/3, 1, 0).
TEST(DeformMesh, NormalsStayNormalToWhatIsStretched)
{
    Mesh mesh = triangle();
    mesh.normals.assign(3, {1, 1, 0});
    mesh.tangents.assign(3, {-1, 1, 0, 1});
    const std::vector<glm::dmat4> joints{glm::scale(glm::dmat4(1.0), glm::dvec3(2, 1, 1)),
                                         glm::scale(glm::dmat4(1.0), glm::dvec3(4, 1, 1))};
    skinMesh(mesh, {2, {0, 1, 0, 1, 0, 1}, std::vector<double>(6, 0.5)}, joints);
    expectNear(mesh.positions[1], {3, 0, 0});
    expectNear(mesh.normals[0], glm::normalize(glm::dvec3(1, 3, 0)));
    expectNear(glm::dvec3(mesh.tangents[0]), glm::normalize(glm::dvec3(-3, 1, 0)), 1e-7);
    EXPECT_EQ(mesh.tangents[0].w, 1.0F);
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(DeformMesh, FrontStaysFrontInAMirror)
{
    Mesh mesh = triangle();
    mesh.normals.assign(3, {1, 0, 1});
    mesh.tangents.assign(3, {0, 1, 0, 1});
    skinMesh(mesh, follow({0, 0, 0}), std::vector{glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, 1))});
    expectNear(mesh.positions[1], {-1, 0, 0});
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 2, 1}));
    expectNear(mesh.normals[0], glm::normalize(glm::dvec3(-1, 0, 1)));
    EXPECT_EQ(mesh.tangents[0].w, -1.0F);
}

TEST(DeformMesh, FlatJointsKeepTheNormalOfTheirPlane)
{
    Mesh mesh = triangle();
    mesh.normals.assign(3, {0.6, 0, 0.8});
    skinMesh(mesh, follow({0, 0, 0}), std::vector{glm::scale(glm::dmat4(1.0), glm::dvec3(1, 1, 0))});
    expectNear(mesh.normals[0], {0, 0, 1});
}

TEST(DeformMesh, JointsWithoutWeightNeedNotExist)
{
    Mesh mesh = triangle();
    skinMesh(mesh, {2, {0, 99, 0, 99, 0, 99}, {1, 0, 1, 0, 1, 0}}, std::vector{glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, 5))});
    expectNear(mesh.positions[2], {0, 1, 5});
}

}  // namespace
}  // namespace glim::test
