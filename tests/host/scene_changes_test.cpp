// What the user of the window changes of the scene, and the way back.
#include "host/preview/scene_changes.hpp"
#include "host/preview/scene_panel.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

LoadOptions turned(float degrees)
{
    LoadOptions options;
    options.environmentRotation = degrees;
    return options;
}

TEST(SceneChangesTest, UndoesAnActionAtOnce)
{
    SceneChanges changes(turned(1.0F));
    changes.change(turned(2.0F), 1);
    changes.change(turned(3.0F), 1);  // of the same drag
    changes.change(turned(4.0F), 2);
    EXPECT_EQ(changes.count(), 2U);
    changes.undo();
    EXPECT_EQ(changes.options(), turned(3.0F));
    changes.change(turned(5.0F), 2);  // is another change, which can be undone
    EXPECT_EQ(changes.count(), 2U);
    changes.undo();
    changes.undo();
    EXPECT_EQ(changes.options(), turned(1.0F));
    EXPECT_EQ(changes.count(), 0U);
}

// The time is the timeline's.
TEST(SceneChangesTest, WhatIsRefusedIsNoChange)
{
    SceneChanges changes(turned(1.0F));
    LoadOptions shown = turned(1.0F);
    shown.at = 0.5;
    changes.change(turned(400.0F), 1);
    changes.giveUp(shown);
    EXPECT_EQ(changes.options(), turned(1.0F));
    EXPECT_EQ(changes.count(), 0U);
}

TEST(DragSunTest, GoesRoundAndStopsAtTheZenith)
{
    const Sun sun{170.0, 80.0, 2.0F};
    EXPECT_EQ(dragSun(sun, {0.0, 0.0}, 100.0), sun);
    EXPECT_EQ(dragSun(sun, {50.0, 0.0}, 100.0), (Sun{-100.0, 80.0, 2.0F})) << "half of the height is a quarter turn";
    EXPECT_EQ(dragSun(sun, {0.0, -50.0}, 100.0), (Sun{170.0, 90.0, 2.0F}));
    EXPECT_EQ(dragSun(sun, {0.0, 10.0}, 100.0), (Sun{170.0, 62.0, 2.0F})) << "down";
}

TEST(FindMapsTest, FindsThoseBesideTheScene)
{
    const test::ScratchFolder folder;
    for (const char* name : {"b.hdr", "a.hdr", "film.exr", "scene.gltf", "c.HDR.txt"}) {
        test::writeText(folder / name, "");
    }
    const std::filesystem::path scene = folder / "scene.gltf", other = folder / "film.exr", a = folder / "a.hdr", b = folder / "b.hdr";
    LoadOptions options;
    EXPECT_EQ(findMaps(scene, options), (std::vector{a, b}));
    options.environment = other;
    EXPECT_EQ(findMaps(scene, options), (std::vector{other, a, b}));
    options.environment = b;
    EXPECT_EQ(findMaps(scene, options), (std::vector{b, a}));
    EXPECT_EQ(findMaps(folder / "missing" / "scene.gltf", LoadOptions{}), std::vector<std::filesystem::path>{});
}

}  // namespace
}  // namespace glim
