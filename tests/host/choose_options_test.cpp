// A scene file whose options change: the scene is what a fresh start gives, and what they do not touch is kept.
#include "host/error.hpp"
#include "host/render/prepare_scene.hpp"
#include "host/scene/make_floor.hpp"
#include "tests/support/edit_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <set>

namespace glim::test {
namespace {

using nlohmann::json;
using Change = std::function<void(LoadOptions&)>;

class ChooseOptionsTest : public testing::Test {
protected:
    ChooseOptionsTest() { writeText(path_, variedTriangle().toGltf()); }

    ScratchFolder folder_;
    std::string path_ = folder_ / "scene.gltf";
};

void addStudio(LoadOptions& options) { options.environment = BuiltInEnvironment::Studio; }
void addFloor(LoadOptions& options) { options.floor.emplace(); }

// From each choice to the next, so that nothing of one is left in another.
TEST_F(ChooseOptionsTest, GivesTheSceneOfAFreshStart)
{
    struct Case {
        const char* what;
        Change change;
        bool keepsNodes;  // of the tree, from the scene as the file has it
    };
    const std::vector<Case> cases{
        {"constant", [](LoadOptions& o) { o.environment = glm::vec3(1.0F, 0.5F, 0.25F); }, true},
        {"studio", addStudio, true},
        {"none", [](LoadOptions& o) { o.environment = BuiltInEnvironment::None; }, true},
        {"rotation", [](LoadOptions& o) { addStudio(o), o.environmentRotation = 30.0F; }, true},
        {"strength", [](LoadOptions& o) { addStudio(o), o.environmentStrength = 0.25F; }, true},
        {"strength of what the file leaves to glim", [](LoadOptions& o) { o.environmentStrength = 0.25F; }, true},
        {"background", [](LoadOptions& o) { addStudio(o), o.environmentBackground = false; }, true},
        {"sun",
         [](LoadOptions& o) {
             o.sun = Sun{10.0, 20.0, 3.0F};
         },
         true},
        {"variant", [](LoadOptions& o) { o.variant = "night"; }, false},
        {"floor", addFloor, false},
        {"floor's colour", [](LoadOptions& o) { addFloor(o), o.floor->color = glm::vec3(0.5F); }, false},
        {"floor's height", [](LoadOptions& o) { addFloor(o), o.floor->height = -2.0; }, false},
        {"catcher", [](LoadOptions& o) { addFloor(o), o.catchers = {kFloorName}; }, false},
        {"edit",
         [](LoadOptions& o) {
             o.edits = {{"/nodes/0/translation", "[1, 0, 0]"}};
         },
         false},
        {"floor under an edit",
         [](LoadOptions& o) {
             addFloor(o), o.edits = {{"/nodes/0/translation", "[0, -3, 0]"}};
         },
         false},
        {"hidden lamp",
         [](LoadOptions& o) {
             o.edits = {{"/nodes/1/extensions/KHR_node_visibility/visible", "false"}};
         },
         true},
        {"time", [](LoadOptions& o) { o.at = 0.5; }, false},
        {"floor at a time", [](LoadOptions& o) { addFloor(o), o.at = 0.75; }, false},
        {"framed at a time", [](LoadOptions& o) { o.framed = true, o.at = 0.25; }, false},
        {"radius of points", [](LoadOptions& o) { o.pointRadius = 0.25; }, false},
        {"back faces", [](LoadOptions& o) { o.showsBackFaces = true; }, false},
        {"another file beside it",
         [this](LoadOptions& o) {
             o.additions = {{path_, glm::dmat4(glm::dmat3(2.0))}};
         },
         false},
    };
    SceneFile file(path_);
    PreparedScene prepared;
    updateScene(prepared, file, std::nullopt, SplitRule::Sah);
    const std::uint64_t own = fingerprint(prepared.flat);
    const auto expectFresh = [&](const LoadOptions& options, const std::string& what) {
        const PreparedScene fresh = prepareScene(path_, options);
        EXPECT_EQ(fingerprint(prepared.flat), fingerprint(fresh.flat)) << what;
        EXPECT_EQ(prepared.scene.cameras.size(), fresh.scene.cameras.size()) << what;
        EXPECT_EQ(prepared.scene.cameras[0].position, fresh.scene.cameras[0].position) << what;
    };
    for (const Case& c : cases) {
        LoadOptions options;
        c.change(options);
        const SharedVector nodes = prepared.flat.nodes;
        changeScene(prepared, file, options, SplitRule::Sah);
        expectFresh(options, c.what);
        if (c.keepsNodes) {
            EXPECT_TRUE(prepared.flat.nodes.isSameAs(nodes)) << c.what;
        }
        changeScene(prepared, file, {}, SplitRule::Sah);
        EXPECT_EQ(fingerprint(prepared.flat), own) << c.what << " undone";
    }
    for (const Case& c : cases) {
        LoadOptions options;
        c.change(options);
        changeScene(prepared, file, options, SplitRule::Sah);
        expectFresh(options, std::string(c.what) + " after another");
    }
}

// Under a strength of 2 the same environment has twice the radiance; the sun and the file's lamp stay.
TEST_F(ChooseOptionsTest, TheStrengthScalesAnyEnvironment)
{
    for (const Change& light : {Change(addStudio), Change([](LoadOptions& o) { o.environment = glm::vec3(1.0F, 0.5F, 0.25F); })}) {
        LoadOptions options;
        light(options);
        options.sun = Sun{0.0, 45.0, 3.0F};
        const PreparedScene once = prepareScene(path_, options);
        options.environmentStrength = 2.0F;
        const PreparedScene twice = prepareScene(path_, options);
        EXPECT_EQ(twice.flat.environment, 2.0F * once.flat.environment);
        ASSERT_EQ(once.scene.lights.size(), 2U);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(twice.scene.lights[i].intensity, once.scene.lights[i].intensity);
        }
    }
}

// Whatever refuses, and wherever: the scene and the file stay.
TEST_F(ChooseOptionsTest, ARefusalChangesNothing)
{
    SceneFile file(path_);
    PreparedScene prepared;
    LoadOptions before;
    before.variant = "night";
    before.floor.emplace();
    changeScene(prepared, file, before, SplitRule::Sah);
    const std::uint64_t own = fingerprint(prepared.flat);
    const std::vector<Change> refused{[](LoadOptions& o) { o.variant = "noon"; },
                                      [](LoadOptions& o) { o.catchers = {"glass"}; },
                                      [](LoadOptions& o) { o.environment = std::filesystem::path("missing.hdr"); },
                                      [](LoadOptions& o) {
                                          o.edits = {{"/materials/9/alphaCutoff", "1"}};
                                      },
                                      [](LoadOptions& o) { o.at = 0.5, o.animation = "walk"; },
                                      [](LoadOptions& o) {
                                          o.additions = {{"missing.gltf", glm::dmat4(1.0)}};
                                      },
                                      [](LoadOptions& o) { o.environment = glm::vec3(1e30F), o.environmentStrength = 1e9F; }};
    for (const Change& change : refused) {
        LoadOptions options = before;
        change(options);
        EXPECT_THROW(changeScene(prepared, file, options, SplitRule::Sah), InputError);
        EXPECT_EQ(file.options(), before);
        EXPECT_EQ(fingerprint(prepared.flat), own);
        changeScene(prepared, file, before, SplitRule::Sah);
        EXPECT_EQ(fingerprint(prepared.flat), own);
    }
}

// A shelf (0) with a vase (1) that has a lid (2) and a lamp's bulb (3), whose node has the light (4); a table (5) that has a leg (6); and
// an empty node (7) with a cup (8). The shelf cannot be hidden without what it carries.
TEST(IsolateNodeTest, HidesAllThatCanBeHidden)
{
    GltfBuilder builder;
    const std::size_t mesh = builder.addTriangleMesh();
    const json shape = {{"mesh", mesh}};
    const auto add = [&](json node, const std::vector<int>& children) {
        if (!children.empty()) {
            node["children"] = children;
        }
        builder.append("nodes", node);
    };
    add(shape, {1, 3});
    add(shape, {2});
    add(shape, {});
    add(shape, {4});
    add({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}, {});
    add(shape, {6});
    add(shape, {});
    add(json::object(), {8});
    add(shape, {});
    builder.document["scenes"] = {{{"nodes", {0, 5, 7}}}};
    builder.document["scene"] = 0;
    builder.document["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    const ScratchFolder folder;
    writeText(folder / "shelf.gltf", builder.toGltf());
    writeText(folder / "cup.gltf", variedTriangle().toGltf());
    LoadOptions options;
    options.additions = {{folder / "cup.gltf", glm::dmat4(1.0)}};
    options.floor.emplace();
    const auto drawn = [&](std::optional<std::uint32_t> isolated) {
        SceneFile file(folder / "shelf.gltf", options);
        Scene scene = file.sceneAt(std::nullopt);
        if (isolated) {
            std::vector<Edit> edits;
            for (const std::string& pointer : file.pointersToOthers(scene, *isolated)) {
                edits.push_back({pointer + "/extensions/KHR_node_visibility/visible", "false"});
            }
            edit(file, edits);
            scene = file.sceneAt(std::nullopt);
        }
        EXPECT_EQ(scene.lights.size(), 2U);
        std::set<std::uint32_t> nodes;
        for (const MeshInstance& instance : scene.instances) {
            nodes.insert(instance.node);
        }
        return nodes;
    };
    using Nodes = std::set<std::uint32_t>;
    const std::uint32_t cup = 9, cloud = 11, floor = 12;  // of the added file, and beyond
    EXPECT_EQ(drawn(std::nullopt), (Nodes{0, 1, 2, 3, 5, 6, 8, cup, cloud, floor}));
    EXPECT_EQ(drawn(1), (Nodes{0, 1, 2, 3, floor}));
    EXPECT_EQ(drawn(2), (Nodes{0, 1, 2, 3, floor}));
    EXPECT_EQ(drawn(6), (Nodes{0, 3, 5, 6, floor}));
    EXPECT_EQ(drawn(8), (Nodes{0, 3, 8, floor}));
    EXPECT_EQ(drawn(cup), (Nodes{0, 3, cup, floor}));
}

}  // namespace
}  // namespace glim::test
