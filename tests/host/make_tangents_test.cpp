#include "host/scene/make_tangents.hpp"
#include "tests/harness/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace glim {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<glm::vec4> tangentsOf(const Mesh& mesh) { return makeTangents(mesh.indices, mesh.positions, mesh.normals, mesh.uv0); }

// The unit square in the plane z = 0 seen from +z, as a picture lies on it: v = 1 - y.
Mesh square()
{
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.normals.assign(4, glm::dvec3(0, 0, 1));
    mesh.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

// Two squares side by side, x in [-1, 1]; the texture's left half is mirrored, and sheared. They share the vertices of x = 0: 1 and 4.
Mesh mirroredHalves()
{
    Mesh mesh;
    mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.normals.assign(6, glm::dvec3(0, 0, 1));
    mesh.uv0 = {{1, 1.5F}, {0, 1}, {1, 1}, {1, 0.5F}, {0, 0}, {1, 0}};
    mesh.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    return mesh;
}

// Three triangles around vertex 0, each with another tangent: a quarter, a quarter and an eighth of a turn.
Mesh fan()
{
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
    mesh.normals.assign(5, glm::dvec3(0, 0, 3));
    mesh.uv0 = {{0, 0}, {1, 0}, {0, -1}, {-1, -2}, {-1, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3, 0, 3, 4};
    return mesh;
}

// u goes once around to the east, v from the north pole (+z) to the south pole. Bumps make all triangles differ.
Mesh sphere(std::uint32_t columns, std::uint32_t rows, double bumps = 0.0)
{
    Mesh mesh;
    for (std::uint32_t row = 0; row <= rows; ++row) {
        for (std::uint32_t column = 0; column <= columns; ++column) {
            const double longitude = 2.0 * std::numbers::pi * (column % columns) / columns;
            const double colatitude = std::numbers::pi * row / rows;
            const double size = row == 0 || row == rows ? 0.0 : std::sin(colatitude);
            const glm::dvec3 normal(size * std::cos(longitude), size * std::sin(longitude), std::cos(colatitude));
            mesh.positions.push_back(normal * (1.0 + bumps * size * std::sin(5.0 * longitude) * std::sin(3.0 * colatitude)));
            mesh.normals.push_back(normal);
            mesh.uv0.emplace_back(static_cast<float>(column) / static_cast<float>(columns),
                                  static_cast<float>(row) / static_cast<float>(rows));
        }
    }
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t north = row * (columns + 1) + column, south = north + columns + 1;
            mesh.indices.insert(mesh.indices.end(), {north, south, south + 1, north, south + 1, north + 1});
        }
    }
    return mesh;
}

// The bumpy sphere with its western half's uv mirrored.
Mesh mirroredSphere()
{
    Mesh mesh = sphere(24, 13, 0.2);
    for (glm::vec2& uv : mesh.uv0) {
        uv.x = std::min(uv.x, 1.0F - uv.x);
    }
    return mesh;
}

Mesh withoutIndices(const Mesh& shared)
{
    Mesh mesh;
    for (const std::uint32_t index : shared.indices) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.indices.size()));
        mesh.positions.push_back(shared.positions[index]);
        if (!shared.normals.empty()) {
            mesh.normals.push_back(shared.normals[index]);
        }
        mesh.uv0.push_back(shared.uv0[index]);
    }
    return mesh;
}

glm::dvec3 faceNormalAt(const Mesh& mesh, std::size_t corner)
{
    const std::uint32_t* indices = mesh.indices.data() + corner / 3 * 3;
    const glm::dvec3& origin = mesh.positions[indices[0]];
    return glm::normalize(glm::cross(mesh.positions[indices[1]] - origin, mesh.positions[indices[2]] - origin));
}

void expectUnit(const glm::vec4& tangent)
{
    EXPECT_NEAR(glm::length(glm::dvec3(tangent)), 1.0, 1e-6);
    EXPECT_EQ(std::abs(tangent.w), 1.0F);
}

// Of a mesh whose normals are good, or none.
void expectValid(const Mesh& mesh, const std::vector<glm::vec4>& tangents)
{
    ASSERT_EQ(tangents.size(), mesh.indices.size());
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        expectUnit(tangents[corner]);
        const glm::dvec3 normal = mesh.normals.empty() ? faceNormalAt(mesh, corner) : glm::normalize(mesh.normals[mesh.indices[corner]]);
        EXPECT_NEAR(glm::dot(glm::dvec3(tangents[corner]), normal), 0.0, 1e-6) << corner;
    }
}

void expectNear(const glm::vec4& tangent, const glm::vec4& expected, float tolerance = 1e-6F)
{
    EXPECT_LT(glm::length(glm::vec3(tangent) - glm::vec3(expected)), tolerance)
        << tangent.x << ' ' << tangent.y << ' ' << tangent.z << ", not " << expected.x << ' ' << expected.y << ' ' << expected.z;
    EXPECT_EQ(tangent.w, expected.w);
}

// `tangents`, at the corners of fan() around its centre, are the mean of these triangles'.
void expectMean(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, const std::vector<glm::vec4>& tangents)
{
    glm::vec4 sum(0.0F);
    for (const std::uint32_t triangle : triangles) {
        Mesh alone = mesh;
        alone.indices.assign(mesh.indices.begin() + 3 * triangle, mesh.indices.begin() + 3 * triangle + 3);
        sum += tangentsOf(alone)[0] * (triangle == 2 ? 0.5F : 1.0F);
    }
    for (std::size_t triangle = 0; triangle < 3; ++triangle) {
        expectNear(tangents[3 * triangle], glm::vec4(glm::normalize(glm::vec3(sum)), std::copysign(1.0F, sum.w)));
    }
}

TEST(MakeTangentsTest, AStraightPictureHasTangentsToTheRightAndBitangentsUp)
{
    const std::vector<glm::vec4> tangents = tangentsOf(square());
    EXPECT_EQ(tangents, std::vector<glm::vec4>(6, glm::vec4(1, 0, 0, 1)));
    EXPECT_EQ(glm::cross(glm::vec3(0, 0, 1), glm::vec3(tangents[0])) * tangents[0].w, glm::vec3(0, 1, 0));
}

TEST(MakeTangentsTest, TurnWithTheTexture)
{
    Mesh mesh = square();
    const glm::dvec2 right(std::cos(0.4), std::sin(0.4));
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec2 position(mesh.positions[i]);
        mesh.uv0[i] = {glm::dot(position, right), -3.0 * glm::dot(position, glm::dvec2(-right.y, right.x))};
    }
    for (const glm::vec4& tangent : tangentsOf(mesh)) {
        expectNear(tangent, glm::vec4(right, 0.0, 1.0));
    }
}

TEST(MakeTangentsTest, SplitTheVerticesWhereATextureIsMirrored)
{
    Mesh mesh = mirroredHalves();
    const std::vector<glm::vec4> corners = tangentsOf(mesh);
    for (std::size_t corner = 0; corner < 12; ++corner) {
        expectNear(corners[corner], corner < 6 ? glm::vec4(glm::normalize(glm::vec3(-2, 1, 0)), -1) : glm::vec4(1, 0, 0, 1));
    }
    mesh.colors.assign(6, glm::vec4(1.0F));
    mesh.colors[4] = glm::vec4(0.5F);
    EXPECT_EQ(addTangents(mesh, false), 0U);
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 4, 0, 4, 3, 6, 2, 5, 6, 5, 7}));
    EXPECT_EQ(mesh.positions.size(), 8U);
    EXPECT_EQ(mesh.positions[6], mesh.positions[1]);
    EXPECT_EQ(mesh.normals[7], mesh.normals[4]);
    EXPECT_EQ(mesh.uv0[7], mesh.uv0[4]);
    EXPECT_EQ(mesh.colors[7], mesh.colors[4]);
    EXPECT_TRUE(mesh.uv1.empty());
    ASSERT_EQ(mesh.tangents.size(), 8U);
    for (std::size_t corner = 0; corner < 12; ++corner) {
        EXPECT_EQ(mesh.tangents[mesh.indices[corner]], corners[corner]);
    }
}

TEST(MakeTangentsTest, AreMeansWeightedByAngle) { expectMean(fan(), {0, 1, 2}, tangentsOf(fan())); }

TEST(MakeTangentsTest, OnASphereTheyGoEast)
{
    const Mesh mesh = sphere(64, 32);
    const std::vector<glm::vec4> tangents = tangentsOf(mesh);
    expectValid(mesh, tangents);
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const glm::dvec3& normal = mesh.normals[mesh.indices[corner]];
        if (std::abs(normal.z) < 0.95) {
            const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), normal));
            expectNear(tangents[corner], glm::vec4(east, 1.0), 0.06F);  // at the seam half a column away
        }
    }
}

TEST(MakeTangentsTest, NeighboursAreFoundByTheirValues)
{
    for (const Mesh& shared : {mirroredSphere(), sphere(24, 13, 0.2)}) {
        const std::vector<glm::vec4> tangents = tangentsOf(shared);
        expectValid(shared, tangents);
        EXPECT_EQ(tangentsOf(withoutIndices(shared)), tangents);
    }
    Mesh signedZeros = withoutIndices(fan());
    for (std::size_t i = 3; i < 6; ++i) {
        signedZeros.positions[i].z = -0.0;
        signedZeros.normals[i].x = -0.0;
    }
    EXPECT_EQ(tangentsOf(signedZeros), tangentsOf(fan()));
}

TEST(MakeTangentsTest, OfFourTrianglesAtAnEdgeTwoPairsAreNeighbours)
{
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}};
    mesh.normals.assign(6, glm::dvec3(0, 0, 1));
    mesh.uv0 = {{0, 0}, {0, 1}, {1, 0}, {1, 2}, {-1, 0}, {-1, -1}};
    mesh.indices = {0, 1, 2, 0, 1, 3, 1, 0, 4, 1, 0, 5};
    const std::vector<glm::vec4> tangents = tangentsOf(mesh);
    EXPECT_EQ(tangents[0], tangents[7]);
    EXPECT_EQ(tangents[3], tangents[10]);
    EXPECT_NE(tangents[0], tangents[3]);
}

TEST(MakeTangentsTest, DoNotDependOnTheOrderOfTriangles)
{
    const Mesh mesh = mirroredSphere();
    const std::vector<glm::vec4> expected = tangentsOf(mesh);
    Random random(1);
    std::vector<std::uint32_t> order(mesh.indices.size() / 3);
    std::iota(order.begin(), order.end(), 0U);
    for (std::uint32_t i = static_cast<std::uint32_t>(order.size()); i > 1; --i) {
        std::swap(order[i - 1], order[random.below(i)]);
    }
    Mesh shuffled = mesh;
    std::vector<std::uint32_t> corners;  // by the shuffled mesh's corner, turned as well
    for (const std::uint32_t triangle : order) {
        const std::uint32_t turn = random.below(3);
        for (std::uint32_t i = 0; i < 3; ++i) {
            corners.push_back(3 * triangle + (i + turn) % 3);
            shuffled.indices[corners.size() - 1] = mesh.indices[corners.back()];
        }
    }
    const std::vector<glm::vec4> tangents = tangentsOf(shuffled);
    const std::size_t polar = 3 * 2 * 24;  // corners of either pole's row, where collapsed triangles take the first tangent
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (corners[i] >= polar && corners[i] < corners.size() - polar) {
            expectNear(tangents[i], expected[corners[i]]);
        }
    }
}

TEST(MakeTangentsTest, AreTheSameEachTime)
{
    Mesh first = mirroredSphere(), second = mirroredSphere();
    addTangents(first, false);
    addTangents(second, false);
    EXPECT_EQ(first.tangents, second.tangents);
    EXPECT_EQ(first.indices, second.indices);
    const std::vector<std::uint32_t> indices = first.indices;
    const std::vector<glm::vec4> tangents = first.tangents;
    addTangents(first, false);
    EXPECT_EQ(first.indices, indices) << "what is split already stays";
    EXPECT_EQ(first.tangents, tangents);
}

// The middle one of three squares in a row.
TEST(MakeTangentsTest, TrianglesWithoutUvAreaTakeTheirNeighboursTangents)
{
    Mesh mesh;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 2; ++row) {
            mesh.positions.emplace_back(column, row, 0);
            mesh.uv0.emplace_back(column < 2 ? column : column - 1, 1 - row);
        }
    }
    mesh.normals.assign(8, glm::dvec3(0, 0, 1));
    for (const std::uint32_t first : {0U, 2U, 4U}) {
        mesh.indices.insert(mesh.indices.end(), {first, first + 2, first + 3, first, first + 3, first + 1});
    }
    EXPECT_EQ(tangentsOf(mesh), std::vector<glm::vec4>(18, glm::vec4(1, 0, 0, 1)));
    EXPECT_EQ(addTangents(mesh, false), 0U);
    EXPECT_EQ(mesh.positions.size(), 8U);
}

// Whichever way uv go around, what has no uv area connects its neighbours.
TEST(MakeTangentsTest, TrianglesWithoutUvAreaAreNoSeams)
{
    for (const float sign : {1.0F, -1.0F}) {
        Mesh mesh = fan();
        mesh.uv0 = {{0, 0}, {sign, 0}, {0, -1}, {0, -2}, {-sign, -1}};
        const std::vector<glm::vec4> tangents = tangentsOf(mesh);
        EXPECT_EQ(tangents[0].w, sign);
        expectMean(mesh, {0, 2}, tangents);
    }
}

// The second triangle touches the first one at a vertex alone.
TEST(MakeTangentsTest, WhatTheUvDoNotDetermineIsPerpendicularToTheNormal)
{
    for (const float u : {0.0F, kNan, std::numeric_limits<float>::infinity()}) {
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
        mesh.normals.assign(5, glm::dvec3(1, 0, 1));
        mesh.uv0 = {{0, 0}, {1, 0}, {0, -1}, {u, u}, {u, u}};
        mesh.indices = {0, 1, 2, 0, 3, 4};
        const std::vector<glm::vec4> tangents = tangentsOf(mesh);
        expectValid(mesh, tangents);
        EXPECT_EQ(tangents[3], tangents[0]);
        EXPECT_EQ(addTangents(mesh, false), 1U);
        EXPECT_EQ(mesh.positions.size(), 5U);
        mesh.indices = {0, 3, 4, 3, 4, 0};
        EXPECT_EQ(addTangents(mesh, false), 2U);
        expectUnit(mesh.tangents[1]);
    }
}

TEST(MakeTangentsTest, TrianglesWithoutAreaDisturbNothing)
{
    Mesh mesh = square();
    mesh.indices.insert(mesh.indices.begin(), {0, 0, 1});         // shares an edge
    mesh.indices.insert(mesh.indices.end(), {2, 2, 2, 0, 2, 0});  // share vertices
    EXPECT_EQ(tangentsOf(mesh), std::vector<glm::vec4>(15, glm::vec4(1, 0, 0, 1)));
    EXPECT_EQ(addTangents(mesh, false), 0U);
    mesh.positions.emplace_back(5, 5, 5);
    mesh.positions.emplace_back(6, 6, 6);
    mesh.positions.emplace_back(8, 8, 8);
    mesh.normals.resize(7, glm::dvec3(0, 0, 1));
    mesh.uv0.insert(mesh.uv0.end(), {{0, 0}, {0, 1}, {1, 0}});
    mesh.indices.insert(mesh.indices.end(), {4, 5, 6});  // on a line
    expectValid(mesh, tangentsOf(mesh));
    mesh.normals.clear();
    for (const glm::vec4& tangent : tangentsOf(mesh)) {
        expectUnit(tangent);
    }
}

// Here one lies along an edge, with two uv at one position.
TEST(MakeTangentsTest, CollapsedTrianglesDoNotComeBetweenNeighbours)
{
    Mesh mesh = fan();
    const std::vector<glm::vec4> expected = tangentsOf(mesh);
    mesh.positions.push_back(mesh.positions[2]);
    mesh.normals.push_back(mesh.normals[2]);
    mesh.uv0.emplace_back(0.5F);
    mesh.indices.insert(mesh.indices.begin(), {0, 2, 5});
    const std::vector<glm::vec4> tangents = tangentsOf(mesh);
    EXPECT_TRUE(std::equal(tangents.begin() + 3, tangents.end(), expected.begin()));
    EXPECT_EQ(tangents[0], tangents[3]);
    EXPECT_EQ(addTangents(mesh, false), 1U) << "a corner of a uv that no other triangle has";
}

// Two triangles in one group whose tangents cancel, folded back onto each other.
TEST(MakeTangentsTest, TangentsThatCancelStayWithTheirTriangles)
{
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 0, 0}};
    mesh.normals.assign(4, glm::dvec3(0, 0, 1));
    mesh.uv0 = {{0, 0}, {0, 1}, {1, 0}, {-1, 0}};
    mesh.indices = {0, 1, 2, 1, 0, 3};
    const std::vector<glm::vec4> tangents = tangentsOf(mesh);
    for (std::size_t corner = 0; corner < 6; ++corner) {
        expectNear(tangents[corner], glm::vec4(corner < 3 ? 1 : -1, 0, 0, 1));
    }
}

TEST(MakeTangentsTest, AFlatMeshIsSplitAtItsEdges)
{
    Mesh mesh = sphere(12, 6, 0.2);
    mesh.normals.clear();
    const std::vector<glm::vec4> tangents = tangentsOf(mesh);
    const std::size_t columns = 12;
    for (std::size_t corner = 6 * columns; corner < mesh.indices.size() - 6 * columns; ++corner) {  // without the poles' triangles
        expectUnit(tangents[corner]);
        EXPECT_NEAR(glm::dot(glm::dvec3(tangents[corner]), faceNormalAt(mesh, corner)), 0.0, 1e-6);
        EXPECT_EQ(tangents[corner], tangents[corner / 3 * 3]) << "one per triangle";
    }
    Mesh split = mesh;
    EXPECT_EQ(addTangents(split, false), 2 * columns) << "collapsed, at the poles";
    EXPECT_TRUE(split.normals.empty());
    EXPECT_EQ(split.tangents.size(), split.positions.size());
    EXPECT_EQ(split.uv0.size(), split.positions.size());
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        EXPECT_EQ(split.tangents[split.indices[corner]], tangents[corner]);
        EXPECT_EQ(split.positions[split.indices[corner]], mesh.positions[mesh.indices[corner]]);
        EXPECT_EQ(split.uv0[split.indices[corner]], mesh.uv0[mesh.indices[corner]]);
    }
}

TEST(MakeTangentsTest, BadNormalsGiveWayToTheFace)
{
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, infinity, std::numeric_limits<double>::quiet_NaN()}) {
        Mesh mesh = square();
        mesh.normals[1] = {bad, 0, 0};
        mesh.normals[2] = {0, 0, 1e-320};
        mesh.normals[3] = {0, 0, 1e300};
        EXPECT_EQ(tangentsOf(mesh), std::vector<glm::vec4>(6, glm::vec4(1, 0, 0, 1)));
    }
}

TEST(MakeTangentsTest, UseTheSetOfUvAskedFor)
{
    Mesh mesh = square();
    mesh.uv1 = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};  // u goes up, v to the right
    mesh.positions.emplace_back(9, 9, 9);         // of no triangle
    mesh.normals.emplace_back(0.0);
    mesh.uv0.emplace_back(0.0F);
    mesh.uv1.emplace_back(0.0F);
    EXPECT_EQ(addTangents(mesh, true), 0U);
    ASSERT_EQ(mesh.tangents.size(), 5U);
    EXPECT_EQ(mesh.tangents[0], glm::vec4(0, 1, 0, 1));
    expectUnit(mesh.tangents[4]);
    addTangents(mesh, false);
    EXPECT_EQ(mesh.tangents[0], glm::vec4(1, 0, 0, 1));
}

TEST(MakeTangentsTest, AnEmptyMeshHasNone)
{
    Mesh mesh;
    EXPECT_TRUE(tangentsOf(mesh).empty());
    EXPECT_EQ(addTangents(mesh, false), 0U);
    EXPECT_TRUE(mesh.tangents.empty());
}

// Few distinct values, so that much coincides, with some that no file should have.
TEST(MakeTangentsTest, AreUnitVectorsWhateverTheMesh)
{
    Random random(2);
    const std::array<double, 8> values{0.0, -0.0, 1.0, -1.0, 0.5, 1e-300, 1e300, std::numeric_limits<double>::quiet_NaN()};
    for (int round = 0; round < 300; ++round) {
        const std::uint32_t kinds = 3 + random.below(6);
        const auto value = [&] { return values[random.below(kinds)]; };
        Mesh mesh;
        for (int vertex = 0; vertex < 12; ++vertex) {
            mesh.positions.emplace_back(value(), value(), value());
            mesh.normals.emplace_back(value(), value(), value());
            mesh.uv0.emplace_back(value(), value());
        }
        for (int i = 0; i < 60; ++i) {
            mesh.indices.push_back(random.below(12));
        }
        if (round % 3 == 0) {
            mesh.normals.clear();
        }
        const std::vector<glm::vec4> tangents = tangentsOf(mesh);
        for (const glm::vec4& tangent : tangents) {
            expectUnit(tangent);
        }
        EXPECT_EQ(tangentsOf(withoutIndices(mesh)), tangents);
        addTangents(mesh, false);
        for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
            EXPECT_EQ(mesh.tangents[mesh.indices[corner]], tangents[corner]);
        }
    }
}

}  // namespace
}  // namespace glim
