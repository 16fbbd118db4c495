// Each file of scenes/refused is refused with the sentence that the table in scenes/README.md has for it.
#include "places.h"
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace glim::test {
namespace {

const std::filesystem::path kScenes = std::filesystem::path(GLIM_SOURCE_DIR) / "scenes";

struct Refusal {
    std::string id, place, value;
};

// Rows "| `name` | id | place | value |" below the heading "Refused".
std::map<std::string, Refusal> readTable()
{
    std::map<std::string, Refusal> table;
    std::ifstream readme(kScenes / "README.md");
    bool inside = false;
    for (std::string line; std::getline(readme, line);) {
        if (line.rfind("## ", 0) == 0) {
            inside = line.find("Refused") != std::string::npos;
        }
        if (inside && line.rfind("| `", 0) == 0) {
            std::vector<std::string> cells;
            for (std::size_t at = 2, end = line.find(" |", at); end != std::string::npos; at = end + 3, end = line.find(" |", at)) {
                cells.push_back(line.substr(at, end - at));
                std::erase(cells.back(), '`');
            }
            EXPECT_EQ(cells.size(), 4U) << line;
            cells.resize(4);
            table[cells[0]] = {cells[1], cells[2], cells[3]};
        }
    }
    return table;
}

TEST(GltfRefused, EveryFileIsRefusedForItsReason)
{
    const std::map<std::string, Refusal> table = readTable();
    std::set<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(kScenes / "refused")) {
        files.insert(entry.path().filename().string());
    }
    for (const auto& [name, reason] : table) {
        ASSERT_EQ(files.count(name), 1U) << name << " is in the table only";
    }
    ASSERT_GT(files.size(), 50U);
    for (const std::string& name : files) {
        const std::string path = (kScenes / "refused" / name).string();
        ASSERT_EQ(table.count(name), 1U) << name << " is not in the table of scenes/README.md";
        try {
            loadGltf(path);
            ADD_FAILURE() << path << " was not refused";
        } catch (const InputError& error) {
            const auto& [id, place, value] = table.at(name);
            expectMessage(error.message(), error.message().id, {.file = path, .place = place, .value = value});
            EXPECT_EQ(toText(error.message().id), id) << error.what();
            EXPECT_TRUE(std::string(error.what()).starts_with(path + ": ")) << error.what();
        }
    }
}

TEST(GltfRefused, IncompleteCamerasAndSpots)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    for (const char* type : {"perspective", "orthographic"}) {
        builder.document["cameras"] = nlohmann::json::array({{{"type", type}}});
        expectRefused(builder, MessageId::Missing, {.place = std::string("cameras[0].") + type, .expected = type});
    }
    builder.document.erase("cameras");
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = nlohmann::json::array({{{"type", "spot"}}});
    expectRefused(builder, MessageId::Missing, {.place = "extensions.KHR_lights_punctual.lights[0].spot", .expected = "spot"});
}

TEST(GltfRefused, TooManyElementsWithoutABufferView)
{
    GltfBuilder builder;
    const std::size_t positions = builder.append("accessors", {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 4500000}});
    builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", positions}}}})}});
    expectRefused(builder, MessageId::TooLarge, {.value = "4500000"});
    builder.document["accessors"][positions]["count"] = 1000000000000;
    expectRefused(builder, MessageId::TooLarge, {.value = "1000000000000"});
}

TEST(GltfRefused, TheStrengthOfAMapWithItsValue)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    const std::filesystem::path folder = std::filesystem::path(writeTemporary("strength.gltf", "")).parent_path();
    const std::string map = std::filesystem::relative(kScenes / "showcase.hdr", folder).string();
    for (const auto& [strength, said] : {std::pair<nlohmann::json, const char*>(-1, "-1"), {1e39, "1e+39"}, {"x", "not a number"}}) {
        builder.document["scenes"][0]["extras"] = {{"environment", {{"file", map}, {"strength", strength}}}};
        expectRefused(builder, MessageId::OutOfRange, {.place = "scenes[0].extras.environment.strength", .value = said});
    }
}

TEST(GltfRefused, SingularNodesThatCarryNothingAreHarmless)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    builder.addNode({{"scale", {0, 0, 0}}});
    EXPECT_EQ(load(builder).instances.size(), 1U);
}

TEST(GltfRefused, AReplacedEnvironmentIsNotRead)
{
    LoadOptions options;
    options.environment = glm::vec3(1.0F, 2.0F, 3.0F);
    const Scene scene = loadGltf(kScenes / "refused" / "environment_map.gltf", options);
    EXPECT_EQ(scene.environment->radiance, glm::vec3(1.0F, 2.0F, 3.0F));
}

TEST(GltfRefused, InvalidEnvironmentsOnlyWarn)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    builder.document["scenes"][0]["extras"] = {{"environment", {{"uri", "sky.hdr"}}}};
    EXPECT_EQ(findWarning(load(builder).warnings, MessageId::ExtrasIgnored).place, "scenes[0].extras.environment");
    builder.document["scenes"][0]["extras"] = "a string of someone else";
    builder.document["nodes"][0]["extras"] = {1, 2, 3};
    EXPECT_EQ(load(builder).instances.size(), 1U);
}

}  // namespace
}  // namespace glim::test
