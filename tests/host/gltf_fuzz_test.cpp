// Any bytes give a scene that holds its invariants, or one sentence. tools/test --sanitize runs this too.
#include "host/error.hpp"
#include "host/scene/check_scene.hpp"
#include "places.h"
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

namespace glim::test {
namespace {

constexpr int kMutants = 1500;

std::string readText(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// One to four edits: cut, flip a bit, overwrite, or copy a piece to another place.
std::string mutate(std::string text, std::mt19937& random)
{
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    const char* pieces[] = {"-1", "1e39", "99999999999", "null", "[]", "{}", "\"x\"", "0", "1e-320", ",", "\\", "\xff"};
    for (std::size_t edit = 0, edits = 1 + below(4); edit < edits && text.size() > 1; ++edit) {
        const std::size_t at = below(text.size());
        switch (below(6)) {
        case 0: text.resize(below(8) == 0 ? at : text.size()); break;
        case 1: text[at] = static_cast<char>(text[at] ^ static_cast<char>(1U << below(8))); break;
        case 2: text[at] = static_cast<char>(random()); break;
        case 3: text.replace(at, below(4), pieces[below(std::size(pieces))]); break;
        case 4: text.replace(at, below(8), text.substr(below(text.size()), below(8))); break;
        default: {
            const std::size_t digit = text.find_first_of("0123456789", at);
            if (digit != std::string::npos) {
                text.replace(digit, 1, pieces[below(std::size(pieces))]);
            }
        }
        }
    }
    return text;
}

void fuzz(const std::string& original, const std::string& name, const LoadOptions& options = {})
{
    int loaded = 0;
    for (int i = 0; i < kMutants; ++i) {
        std::mt19937 random(static_cast<std::uint32_t>(i));
        const std::string path = writeTemporary(name, mutate(original, random));
        try {
            const Scene scene = loadGltf(path, options);
            checkScene(scene);
            ++loaded;
        } catch (const InputError& error) {
            EXPECT_EQ(error.message().file, path) << "mutant " << i << ": " << error.what();
        } catch (const std::exception& error) {
            ADD_FAILURE() << "mutant " << i << " of " << name << ": " << error.what();
        }
    }
    EXPECT_GT(loaded, kMutants / 100) << "the mutants are too broken to prove anything";
    EXPECT_LT(loaded, kMutants) << "the mutants are too tame to prove anything";
}

TEST(GltfFuzz, SurvivesMutantsOfText) { fuzz(readText(GLIM_SOURCE_DIR "/scenes/light_spot.gltf"), "mutant.gltf"); }

TEST(GltfFuzz, SurvivesMutantsOfGems) { fuzz(readText(GLIM_SOURCE_DIR "/scenes/cornell_gems.gltf"), "mutant.gltf"); }

TEST(GltfFuzz, SurvivesMutantsOfBinaryFiles)
{
    GltfBuilder builder;
    const std::size_t positions = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    const std::size_t normals = builder.addVec3({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    const std::size_t indices = builder.addAccessor({0, 1, 2, 2, 1, 3}, kUnsignedByte, "SCALAR", 6);
    builder.document["accessors"][positions]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", builder.addAov({2})}, {"componentType", kUnsignedByte}}},
        {"values", {{"bufferView", builder.addAov(toBytes<float>({0, 1, 0.5F}))}}}};
    const std::size_t mesh = builder.addMesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"indices", indices}});
    builder.append("nodes", {{"mesh", mesh}, {"scale", {1, -2, 3}}});
    builder.addNode({{"children", {0}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}});
    builder.addNode({{"extras", {{"sphere", {{"radius", 1.5}}}}}});
    fuzz(builder.toGlb(), "mutant.glb");
}

TEST(GltfFuzz, SurvivesMutantsOfPoses)
{
    LoadOptions options;
    options.at = 0.5;
    fuzz(posedTriangle().toGltf(), "mutant.gltf", options);
}

}  // namespace
}  // namespace glim::test
