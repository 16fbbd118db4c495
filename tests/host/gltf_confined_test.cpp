// --confine: a scene names no file outside of its folder.
#include "host/error.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace glim::test {
namespace {

class GltfConfinedTest : public ::testing::Test {
protected:
    GltfConfinedTest()
    {
        std::filesystem::create_directories(folder_ / "scene/inner");
        std::filesystem::create_directories(folder_ / "scene-beside");
        for (const char* file : {"scene/in.bin", "scene/inner/deep.bin", "out.bin", "scene-beside/out.bin"}) {
            std::ofstream(folder_ / file) << std::string(256, '\0');
        }
        std::filesystem::create_symlink("../out.bin", folder_ / "scene/link.bin");
        std::filesystem::create_symlink("inner", folder_ / "scene/folder");
        std::filesystem::create_directory_symlink("scene", folder_ / "alias");
    }
    // What a scene in `folder` is refused with, whose buffer, image or map is `uri`; nothing if it is loaded.
    std::optional<Message> refusalOf(const std::string& what, const std::string& uri, const std::string& folder = "scene")
    {
        GltfBuilder builder;
        builder.addNode({{"mesh", builder.addTriangleMesh()}});
        if (what == "buffers") {
            builder.otherBuffers.push_back({{"byteLength", 256}, {"uri", uri}});
        } else if (what == "images") {
            builder.append("images", {{"uri", uri}});
        } else {
            builder.document["scenes"][0]["extras"] = {{"environment", {{"file", uri}}}};
        }
        const std::filesystem::path scene = folder_.path() / folder / "scene.gltf";
        std::ofstream(scene) << builder.toGltf();
        try {
            LoadOptions options;
            options.confined = true;
            if (what != "environment") {
                options.environment = BuiltInEnvironment::None;
            }
            loadGltf(scene, options);
            return {};
        } catch (const InputError& error) {
            return error.message();
        }
    }

    ScratchFolder folder_;
};

TEST_F(GltfConfinedTest, FilesInItsFolderAreRead)
{
    for (const char* uri : {"in.bin", "./in.bin", "inner/deep.bin", "inner/../in.bin", "../scene/in.bin", "folder/deep.bin", "%69n.bin"}) {
        EXPECT_EQ(refusalOf("buffers", uri), std::nullopt) << uri;
        EXPECT_EQ(refusalOf("buffers", uri, "alias"), std::nullopt) << uri;
    }
}

TEST_F(GltfConfinedTest, OthersAreRefusedBeforeTheyAreOpened)
{
    for (const char* uri :
         {"../out.bin", "inner/../../out.bin", "%2e%2e/out.bin", "link.bin", "../scene-beside/out.bin", "../missing.bin"}) {
        for (const auto& [what, place] :
             {std::pair("buffers", "buffers[1]"), {"images", "images[0]"}, {"environment", "scenes[0].extras.environment"}}) {
            const std::optional<Message> said = refusalOf(what, uri);
            ASSERT_TRUE(said) << what << ' ' << uri;
            expectMessage(*said, MessageId::OutsideFolder, {.file = "scene.gltf", .place = place, .value = uri, .expected = "--confine"});
        }
    }
}

}  // namespace
}  // namespace glim::test
