// What is dropped on the window: another scene, an environment, or what is neither.
#include "host/image/exr.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/preview_fixture.hpp"

#include <fstream>

namespace glim::test {
namespace {

const std::string kLit = "--environment 1,1,1";

// Camera, edits and time are those of the file that was dropped; the light of the options stays. A reload is of the new file.
TEST_F(PreviewTest, ADroppedSceneTakesThePlaceOfTheOther)
{
    std::ofstream(folder / "another one.gltf") << posedTriangle().toGltf();
    GlimCall session = call(
        "0 samples 2\n0 drag left 10,10 40,20\n0 samples 2\n0 drop another one.gltf\n0 samples 2\n0 key C\n0 key P\n"
        "8 samples 2\n0 key Z\n0.2 key P\n0.5 close\n",
        {"--spp", "2", "--environment", "1,1,1", "--set", "/materials/0/pbrMetallicRoughness/metallicFactor=1"});
    bool isSaved = false;
    session.signalWhen = [&](const std::string& err) {
        if (!isSaved && err.find("wrote another one-001") != std::string::npos) {
            isSaved = true;
            GltfBuilder moved = posedTriangle();
            moved.document["nodes"][0]["translation"] = {0.25, 0, 0};
            std::ofstream(folder / "another one.gltf") << moved.toGltf();
        }
        return false;
    };
    const Film first = [&] {
        scene = folder / "another one.gltf";
        return render("--spp 2 " + kLit);
    }();
    const GlimRun done = runGlim(session);
    EXPECT_EQ(done.exitCode, 0) << done.err;
    EXPECT_EQ(done.err.find("validation"), std::string::npos) << done.err;
    EXPECT_EQ(firstLine(done.out).find("--camera 0 --size 96x72"), 0U) << done.out;
    EXPECT_EQ(firstLine(done.out).find("--set"), std::string::npos) << done.out;
    EXPECT_TRUE(sameBits(film(1), first));
    EXPECT_NE(done.err.find("another one.gltf has changed and is loaded again"), std::string::npos) << done.err;
    EXPECT_TRUE(sameBits(film(2), render("--spp 2 " + kLit))) << "there is nothing to undo";
}

// Its sentence is said, and the picture stays.
TEST_F(PreviewTest, WhatIsDroppedAndCannotBeReadChangesNothing)
{
    std::ofstream(folder / "bad.gltf") << "{";
    std::ofstream(folder / "bad.hdr") << "no map";
    const GlimRun session =
        run("0 samples 2\n0 drop bad.gltf\n0 samples 2\n0 drop gone.glb\n0 samples 2\n0 drop bad.hdr\n0 samples 2\n"
            "0 drop notes.txt\n0 samples 2\n0 key C\n0 key P\n0 close\n",
            {"--spp", "2"});
    for (const char* const said : {"bad.gltf: ", "gone.glb: ", "bad.hdr: ", "notes.txt: what is dropped here is a scene (.gltf, .glb)"}) {
        EXPECT_NE(session.err.find(said), std::string::npos) << said << session.err;
    }
    EXPECT_EQ(firstLine(session.out), "--camera 0 --size 96x72");
    EXPECT_TRUE(sameBits(film(1), render("--spp 2")));
}

// As of --environment, and Z undoes it.
TEST_F(PreviewTest, ADroppedMapIsTheEnvironment)
{
    Image map;
    map.width = 4;
    map.height = 2;
    for (const char* const channel : {"R", "G", "B"}) {
        map.channels[channel] = {4.0F, 1.0F, 0.5F, 2.0F, 0.0F, 1.0F, 3.0F, 0.25F};
    }
    writeExr(folder / "sky.EXR", map);
    run("0 samples 2\n0 drop sky.EXR\n0 samples 2\n0 key P\n0 key Z\n0.2 samples 2\n0 key P\n0 close\n", {"--spp", "2", "--zoom", "0.5"});
    const Film lit = render("--spp 2 --zoom 0.5 --environment " + (folder / "sky.EXR").string()), plain = render("--spp 2 --zoom 0.5");
    EXPECT_TRUE(sameBits(film(1), lit));
    EXPECT_TRUE(sameBits(film(2), plain));
    EXPECT_FALSE(sameBits(lit, plain));
}

}  // namespace
}  // namespace glim::test
