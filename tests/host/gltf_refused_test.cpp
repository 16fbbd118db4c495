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

// Rows "| `name` | sentence |" below the heading "Refused".
std::map<std::string, std::string> readTable()
{
    std::map<std::string, std::string> table;
    std::ifstream readme(kScenes / "README.md");
    bool inside = false;
    for (std::string line; std::getline(readme, line);) {
        if (line.rfind("## ", 0) == 0) {
            inside = line.find("Refused") != std::string::npos;
        }
        if (inside && line.rfind("| `", 0) == 0) {
            const std::size_t end = line.find("` | ");
            table[line.substr(3, end - 3)] = line.substr(end + 4, line.size() - end - 4 - 2);
        }
    }
    return table;
}

TEST(GltfRefused, EveryFileIsRefusedWithItsSentence)
{
    const std::map<std::string, std::string> table = readTable();
    std::set<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(kScenes / "refused")) {
        files.insert(entry.path().filename().string());
    }
    for (const auto& [name, sentence] : table) {
        ASSERT_EQ(files.count(name), 1U) << name << " is in the table only";
    }
    ASSERT_GT(files.size(), 50U);
    for (const std::string& name : files) {
        const std::string path = (kScenes / "refused" / name).string();
        const std::string message = loadRefusal(path);
        ASSERT_EQ(table.count(name), 1U) << name << " is not in the table of scenes/README.md";
        EXPECT_EQ(message.rfind(path + ": ", 0), 0U) << message;
        EXPECT_NE(message.find(table.at(name)), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

TEST(GltfRefused, IncompleteCamerasAndSpots)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    for (const char* type : {"perspective", "orthographic"}) {
        builder.document["cameras"] = nlohmann::json::array({{{"type", type}}});
        EXPECT_NE(refusal(builder).find(std::string("cameras[0].") + type + " is missing; expected an object, as its type is " + type),
                  std::string::npos);
    }
    builder.document.erase("cameras");
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = nlohmann::json::array({{{"type", "spot"}}});
    EXPECT_NE(refusal(builder).find("extensions.KHR_lights_punctual.lights[0].spot is missing; expected an object, as its type is spot"),
              std::string::npos);
}

TEST(GltfRefused, TooManyElementsWithoutABufferView)
{
    GltfBuilder builder;
    const std::size_t positions = builder.append("accessors", {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 4500000}});
    builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", positions}}}})}});
    EXPECT_NE(refusal(builder).find("use 4500000 elements of accessors without a bufferView"), std::string::npos);
    builder.document["accessors"][positions]["count"] = 1000000000000;
    EXPECT_NE(refusal(builder).find("use 1000000000000 elements of accessors without a bufferView"), std::string::npos);
}

TEST(GltfRefused, TheStrengthOfAMapWithItsValue)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    const std::filesystem::path folder = std::filesystem::path(writeTemporary("strength.gltf", "")).parent_path();
    const std::string map = std::filesystem::relative(kScenes / "showcase.hdr", folder).string();
    for (const auto& [strength, said] :
         {std::pair<nlohmann::json, const char*>(-1, "is -1"), {1e39, "is 1e+39"}, {"x", "is not a number"}}) {
        builder.document["scenes"][0]["extras"] = {{"environment", {{"file", map}, {"strength", strength}}}};
        const std::string sentence = loadRefusal(writeTemporary("strength.gltf", builder.toGltf()));
        EXPECT_NE(sentence.find(std::string("scenes[0].extras.environment.strength ") + said + "; expected a number from 0"),
                  std::string::npos)
            << sentence;
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
    EXPECT_NE(::testing::PrintToString(load(builder).warnings).find("scenes[0].extras.environment"), std::string::npos);
    builder.document["scenes"][0]["extras"] = "a string of someone else";
    builder.document["nodes"][0]["extras"] = {1, 2, 3};
    EXPECT_EQ(load(builder).instances.size(), 1U);
}

}  // namespace
}  // namespace glim::test
