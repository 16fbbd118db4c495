// Every scene in scenes/ loads as scenes/README.md says, and so do the shared ones where they are at hand.
#include "host/flatten/primitives.hpp"
#include "host/scene/load_gltf.hpp"
#include "places.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

namespace glim {
namespace {

namespace fs = std::filesystem;

struct Counts {
    std::size_t triangles, spheres, lights, cameras, warnings;
};

// The spot light is said to show a part of its scene, and the animated one to be in its rest pose.
TEST(CommittedScenes, LoadWithNoSurprises)
{
    const std::map<std::string, Counts> expected = {
        {"cornell.gltf", {36, 0, 0, 1, 0}},
        {"cornell_spheres.gltf", {12, 2, 0, 1, 0}},
        {"cornell_mirror_glass.gltf", {12, 2, 0, 1, 0}},
        {"cornell_gems.gltf", {112, 0, 0, 1, 0}},
        {"light_point.gltf", {2, 1, 1, 2, 0}},
        {"light_spot.gltf", {2, 1, 1, 2, 1}},
        {"light_directional.gltf", {2, 1, 1, 2, 0}},
        {"furnace.gltf", {12, 0, 0, 1, 0}},
        {"closed_room.gltf", {38, 0, 0, 1, 0}},
        {"shaded_lamp.gltf", {1364, 0, 0, 1, 0}},
        {"door_ajar.gltf", {62, 0, 0, 1, 0}},
        {"mirror_room.gltf", {38, 1, 0, 1, 0}},
        {"veach_mis.gltf", {12, 5, 0, 1, 0}},
        {"many_lights.gltf", {1646, 256, 0, 1, 0}},
        {"materials.gltf", {1458, 34, 0, 1, 0}},
        {"textures.gltf", {36, 0, 0, 1, 0}},
        {"normal_map.gltf", {32, 0, 0, 1, 0}},
        {"alpha.gltf", {16, 1, 1, 1, 0}},
        {"liquid.gltf", {1586, 4, 0, 1, 0}},
        {"wax.gltf", {3906, 0, 0, 1, 0}},
        {"sun_glass.gltf", {50, 1, 0, 2, 0}},
        {"sun_water.gltf", {3532, 1, 0, 1, 0}},
        {"product.gltf", {3458, 0, 0, 1, 1}},
        {"car_paint.gltf", {4562, 0, 0, 1, 0}},
        {"cloth.gltf", {2270, 3, 0, 1, 0}},
        {"showcase.gltf", {8208, 2, 0, 1, 0}},
    };
    std::size_t found = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(GLIM_SOURCE_DIR) / "scenes")) {
        const std::string name = entry.path().filename().string();
        if (entry.path().extension() != ".gltf") {
            continue;
        }
        ASSERT_EQ(expected.count(name), 1U) << name << " has no expectation here";
        const Counts& counts = expected.at(name);
        const Scene scene = loadGltf(entry.path());
        EXPECT_EQ(makePrimitives(scene).triangles.size(), counts.triangles) << name;
        EXPECT_EQ(scene.spheres.size(), counts.spheres) << name;
        EXPECT_EQ(scene.lights.size(), counts.lights) << name;
        EXPECT_EQ(scene.cameras.size(), counts.cameras) << name;
        EXPECT_EQ(scene.warnings.size() + makePrimitives(scene).warnings.size(), counts.warnings)
            << name << ::testing::PrintToString(scene.warnings);
        ++found;
    }
    EXPECT_EQ(found, expected.size());
}

// Volume below a closed surface by the divergence theorem; a hole or a turned triangle shows in it.
TEST(CommittedScenes, SolidsAreClosedAndTurnedOutwards)
{
    using Edge = std::array<float, 6>;
    const auto edge = [](const glm::vec3& a, const glm::vec3& b) { return Edge{a.x, a.y, a.z, b.x, b.y, b.z}; };
    const auto check = [&](const char* file, const std::string& name, bool inward) {
        const Scene scene = loadGltf(fs::path(GLIM_SOURCE_DIR) / "scenes" / file);
        const Primitives primitives = makePrimitives(scene);
        for (std::size_t i = 0; i < scene.instances.size(); ++i) {
            const MeshInstance& instance = scene.instances[i];
            std::map<Edge, int> edges;
            float volume = 0.0F;
            for (std::uint32_t t = primitives.firstTriangles[i]; instance.name == name && t < primitives.firstTriangles[i + 1]; ++t) {
                const auto& v = primitives.triangles[t].vertices;
                volume += glm::dot(v[0], glm::cross(v[1], v[2])) / 6.0F;
                for (int k = 0; k < 3; ++k) {
                    ++edges[edge(v[k], v[(k + 1) % 3])];
                    --edges[edge(v[(k + 1) % 3], v[k])];
                }
            }
            for (const auto& [key, balance] : edges) {
                EXPECT_EQ(balance, 0) << name;
            }
            EXPECT_TRUE(edges.empty() || (volume < 0.0F) == inward) << name << " " << volume;
            EXPECT_TRUE(instance.name != name || !edges.empty());
        }
    };
    check("cornell_gems.gltf", "diamond", false);
    check("cornell_gems.gltf", "sapphire", false);
    check("cornell_gems.gltf", "emerald", false);
    check("cornell.gltf", "tall box", false);
    check("cornell.gltf", "short box", false);
    check("furnace.gltf", "room", true);
}

fs::path findSharedScenes()
{
    const char* given = std::getenv("GLIM_SHARED");
    return (given != nullptr ? fs::path(given) : fs::path(GLIM_SOURCE_DIR) / ".." / "shared") / "scenes";
}

TEST(SharedScenes, LoadWithTheTrianglesTheyWereMadeWith)
{
    const fs::path root = findSharedScenes();
    if (!fs::exists(root / "seed" / "counts.jsonl")) {
        GTEST_SKIP() << "NOT TESTED: " << root << " is missing; set GLIM_SHARED to the folder that holds scenes/";
    }
    std::ifstream lines(root / "seed" / "counts.jsonl");
    std::size_t compared = 0;
    for (std::string line; std::getline(lines, line);) {
        const auto counts = nlohmann::json::parse(line);
        const fs::path file = root / "seed" / (counts["scene"].get<std::string>() + ".glb");
        if (!fs::exists(file)) {
            continue;
        }
        const Scene scene = loadGltf(file);
        EXPECT_EQ(makePrimitives(scene).triangles.size(), counts["triangles"].get<std::size_t>()) << file;
        EXPECT_EQ(scene.spheres.size(), counts["spheres"].get<std::size_t>()) << file;
        ++compared;
    }
    EXPECT_GE(compared, 25U);
}

TEST(SharedScenes, ScansAndArenaLoad)
{
    const fs::path root = findSharedScenes();
    if (!fs::exists(root / "arena") || !fs::exists(root / "scans")) {
        GTEST_SKIP() << "NOT TESTED: " << root << " is missing; set GLIM_SHARED to the folder that holds scenes/";
    }
    const std::map<std::string, std::size_t> triangles = {{"a_cornell", 42},        {"c_mirror_glass", 163858}, {"d_bunny", 278682},
                                                          {"CBdragon202k", 202532}, {"CBelephant89k", 88940},   {"CBnefertiti", 99950},
                                                          {"beast", 64618},         {"bunny69k", 69451}};
    for (const auto& [name, count] : triangles) {
        const fs::path arena = root / "arena" / (name + ".glb");
        const fs::path file = fs::exists(arena) ? arena : root / "scans" / (name + ".glb");
        EXPECT_EQ(makePrimitives(loadGltf(file)).triangles.size(), count) << name;
    }
}

}  // namespace
}  // namespace glim
