// Scripts, waits, events and gestures of the window.
#include "host/error.hpp"
#include "host/preview/pacer.hpp"
#include "host/preview/panels.hpp"
#include "host/preview/picture_size.hpp"
#include "host/preview/surface_edits.hpp"
#include "host/view/view_panel.hpp"
#include "host/window/gestures.hpp"
#include "host/window/gui.hpp"
#include "host/window/latency.hpp"
#include "host/window/notice.hpp"
#include "host/window/pixels.hpp"
#include "host/window/script.hpp"
#include "host/window/widgets.hpp"
#include "tests/support/edit_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <imgui_internal.h>
#include <algorithm>
#include <thread>

namespace glim {
namespace {

using Kind = ScriptStep::Kind;

std::vector<ScriptStep> read(const std::string& text)
{
    const test::ScratchFolder folder;
    test::writeText(folder / "script", text);
    return readScript(folder / "script");
}

TEST(SurfaceEdits, SayWhatDiffers)
{
    const ChosenSurface surface{"a", 0, 0, "/nodes/3", "b.glb#/materials/1"};
    SurfaceChoices before;
    before.baseColor = {1.0F, 0.5F, 0.25F, 0.75F};
    EXPECT_TRUE(listEdits(surface, before, before).empty());
    SurfaceChoices after = before;
    after.baseColor.r = 0.0F;
    after.factors[1] = 0.1F;
    after.translation.y = -2.0F;
    const std::vector<Edit> edits = listEdits(surface, before, after);
    EXPECT_EQ(edits, (std::vector<Edit>{{"b.glb#/materials/1/pbrMetallicRoughness/baseColorFactor", "[0,0.5,0.25,0.75]"},
                                        {"b.glb#/materials/1/pbrMetallicRoughness/roughnessFactor", "0.1"},
                                        {"/nodes/3/translation", "[0,-2,0]"}}));
    EXPECT_TRUE(listEdits({"a", 0, 0, std::nullopt, std::nullopt}, before, after).empty()) << "of what no file has";
    EXPECT_EQ(withEdit(edits, {"/nodes/3/translation", "[1,1,1]"}).size(), 3U);
    EXPECT_EQ(withEdit(edits, {edits[0].pointer, "[1,1,1,1]"}).back().value, "[1,1,1,1]");
}

TEST(SurfaceEdits, HideANode)
{
    const ChosenSurface surface{"a", 0, 0, "/nodes/3", std::nullopt};
    SurfaceChoices after;
    after.hides = true;
    const std::vector<Edit> edits = listEdits(surface, {}, after);
    EXPECT_EQ(edits, (std::vector<Edit>{{"/nodes/3/extensions/KHR_node_visibility/visible", "false"}}));
    EXPECT_TRUE(hides(edits[0]));
    EXPECT_FALSE(hides({edits[0].pointer, "true"}));
    EXPECT_FALSE(hides({"/materials/0/doubleSided", "false"}));
}

// A display's emission stays one; what lights the scene is given with its strength.
TEST(SurfaceEdits, GiveTheEmissionOfDisplaysAndLamps)
{
    const ChosenSurface surface{"a", 0, 0, std::nullopt, "/materials/0"};
    SurfaceChoices before, after;
    after.emission = {1.0F, 0.5F, 0.0F};
    const Edit color{"/materials/0/emissiveFactor", "[1,0.5,0]"};
    const std::string strength = "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength";
    EXPECT_EQ(listEdits(surface, before, after), std::vector{color});
    before.hasStrength = after.hasStrength = true;
    before.emissionStrength = after.emissionStrength = 4.0F;
    EXPECT_EQ(listEdits(surface, before, after), (std::vector<Edit>{color, {strength, "4"}}));
    before = after;
    after.emissionStrength = 8.0F;
    EXPECT_EQ(listEdits(surface, before, after), (std::vector<Edit>{color, {strength, "8"}}));
}

// Each slider changes the property that it shows, of a material as the file's reader makes it.
TEST(SurfaceEdits, FactorsAreThoseOfTheFile)
{
    test::GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    builder.document["meshes"][0]["primitives"][0]["material"] = 0;
    builder.append("materials", {{"name", "paint"}});
    const test::ScratchFolder folder;
    test::writeText(folder / "paint.gltf", builder.toGltf());
    for (std::size_t i = 0; i < kMaterialFactors.size(); ++i) {
        SceneFile file(folder / "paint.gltf");
        Scene scene = file.sceneAt(std::nullopt);
        ChosenSurface surface{"paint", 0, 0, file.pointerToNode(0), file.pointerToMaterial(0)};
        const SurfaceChoices before = choicesOf(surface, scene, file);
        SurfaceChoices after = before;
        after.factors[i] = 0.5F * (kMaterialFactors[i].least + kMaterialFactors[i].most) + 0.01F;
        test::edit(file, listEdits(surface, before, after));
        scene = file.sceneAt(std::nullopt);
        EXPECT_EQ(choicesOf(surface, scene, file).factors, after.factors) << kMaterialFactors[i].name;
    }
}

TEST(ScriptTest, ReadsEveryStep)
{
    const std::vector<ScriptStep> steps = read(
        "# a session\n\n0.5 key v\n0 press w\n0 release W  # up again\n1 drag left 1,2 3.5,4\n"
        "0 drag middle 1,2 3,4\n0 scroll -2\n0 click 7,8\n0 resize 30x20\n0 iconify\n0 restore\n"
        "0 samples 16\n0 key space\n0 key escape\n0 key +\n0 close\n");
    ASSERT_EQ(steps.size(), 15U);
    EXPECT_EQ(steps[0].delay, 0.5);
    EXPECT_EQ(steps[0].kind, Kind::Key);
    EXPECT_EQ(steps[0].key, 'V');
    EXPECT_EQ(steps[1].kind, Kind::Press);
    EXPECT_EQ(steps[2].kind, Kind::Release);
    EXPECT_EQ(steps[3].to, glm::dvec2(3.5, 4.0));
    EXPECT_FALSE(steps[3].pan);
    EXPECT_TRUE(steps[4].pan);
    EXPECT_EQ(steps[5].notches, -2.0);
    EXPECT_EQ(steps[6].from, glm::dvec2(7.0, 8.0));
    EXPECT_EQ(steps[7].size, glm::uvec2(30, 20));
    EXPECT_EQ(steps[10].samples, 16U);
    EXPECT_EQ(steps[11].key, ' ');
    EXPECT_EQ(steps[12].key, kEscape);
    EXPECT_EQ(steps[13].key, '+');
    EXPECT_EQ(steps[14].kind, Kind::Close);
}

TEST(ScriptTest, NamesOfDroppedFilesAreRelativeToItsFolder)
{
    const test::ScratchFolder folder;
    test::writeText(folder / "script", "0 drop two words.glb  # a comment\n0 drop /a/b.hdr\n0 scale 1.5\n");
    const std::vector<ScriptStep> steps = readScript(folder / "script");
    ASSERT_EQ(steps.size(), 3U);
    EXPECT_EQ(steps[0].file, folder / "two words.glb");
    EXPECT_EQ(steps[1].file, "/a/b.hdr");
    EXPECT_EQ(steps[2].scale, 1.5F);
}

// A display that shows two pixels where a screen has one coordinate, and one with a factor that is no whole number.
TEST(PixelScaleTest, PlacesAndSizesGoBothWays)
{
    const PixelScale twice = PixelScale::of({640, 480}, {1280, 960}), odd = PixelScale::of({100, 80}, {150, 120});
    EXPECT_EQ(twice.toPixels({320.5, 10.0}), glm::dvec2(641.0, 20.0));
    EXPECT_EQ(twice.toScreen(glm::dvec2(641.0, 20.0)), glm::dvec2(320.5, 10.0));
    EXPECT_EQ(twice.toScreen(glm::uvec2(1024, 1)), glm::ivec2(512, 1));
    EXPECT_EQ(odd.toPixels({100.0, 80.0}), glm::dvec2(150.0, 120.0));
    EXPECT_EQ(odd.toScreen(glm::uvec2(301, 20)), glm::ivec2(201, 13));
    EXPECT_EQ(PixelScale::of({0, 0}, {0, 0}).toPixels({3.0, 4.0}), glm::dvec2(3.0, 4.0)) << "a hidden window";
}

TEST(PictureSizeTest, HalfOfAWindowLeavesNoPartOfAPixel)
{
    EXPECT_EQ(sizeIn({}, {1601, 901}), glm::uvec2(1601, 901));
    EXPECT_EQ(sizeIn({{}, 2}, {1601, 901}), glm::uvec2(800, 450));
    EXPECT_EQ(sizeIn({{}, 2}, {1, 1}), glm::uvec2(1, 1));
    EXPECT_EQ(sizeIn({glm::uvec2(7, 5)}, {1601, 901}), glm::uvec2(7, 5));
    EXPECT_EQ(choicesOfSize({}).size(), 6U);
    EXPECT_EQ(choicesOfSize({glm::uvec2(512, 512)}).size(), 6U);
    EXPECT_EQ(choicesOfSize({glm::uvec2(7, 5)}).back(), PictureSize{glm::uvec2(7, 5)});
}

TEST(ScriptTest, NamesTheLineThatIsBad)
{
    for (const char* line : {"key V",
                             "-1 key V",
                             "nan key V",
                             "0",
                             "0 jump",
                             "0 key",
                             "0 key VV",
                             "0 key #",
                             "0 drag right 1,2 3,4",
                             "0 drag left 1,2",
                             "0 drag left 1,2 3",
                             "0 scroll up",
                             "0 resize 0x5",
                             "0 resize 1e9x5",
                             "0 samples 0",
                             "0 click 1,2 3",
                             "0 close now",
                             "0 scale 0",
                             "0 scale x",
                             "0 drop",
                             "0 drop  # a.glb"}) {
        test::expectRefusal<InputError>([&] { read(std::string("0 key A\n") + line + "\n"); }, MessageId::Malformed,
                                        {.file = "/script", .place = "line 2", .value = line});
    }
    test::expectRefusal<InputError>([] { readScript("missing"); }, MessageId::FileMissing, {.file = "missing"});
}

TEST(LatencyTest, QuantilesAreOfTheWaits)
{
    Latency latency;
    EXPECT_EQ(latency.quantile(0.5), 0.0);
    for (int i = 100; i >= 1; --i) {
        latency.add(i);
    }
    EXPECT_EQ(latency.count(), 100U);
    EXPECT_EQ(latency.quantile(0.5), 50.0);
    EXPECT_EQ(latency.quantile(0.99), 99.0);
    EXPECT_EQ(latency.quantile(1.0), 100.0);
}

TEST(EventQueueTest, KeepsTheOrderAndWaits)
{
    EventQueue queue;
    EXPECT_TRUE(queue.take(0.001).empty());
    std::thread user([&] {
        for (const char key : {'A', 'B', 'C'}) {
            queue.push({.kind = Event::Kind::KeyDown, .key = key});
        }
    });
    std::string keys;
    while (keys.size() < 3) {
        for (const Event& event : queue.take(10.0)) {
            keys += event.key;
        }
    }
    user.join();
    EXPECT_EQ(keys, "ABC");
    EXPECT_TRUE(queue.isEmpty());
}

Event mouse(Event::Kind kind, glm::dvec2 position, int button = kLeftButton, bool shift = false)
{
    return {.kind = kind, .position = position, .button = button, .shift = shift};
}

TEST(GesturesTest, AClickBecomesADragThreePixelsOn)
{
    using Is = Gesture::Kind;
    Gestures gestures;
    EXPECT_FALSE(gestures.take(mouse(Event::Kind::Move, {9, 9}), false)) << "no button is down";
    EXPECT_FALSE(gestures.take(mouse(Event::Kind::ButtonDown, {10, 10}), false));
    EXPECT_FALSE(gestures.take(mouse(Event::Kind::Move, {12, 10}), false));
    const auto click = gestures.take(mouse(Event::Kind::ButtonUp, {12, 10}), false);
    ASSERT_TRUE(click && click->kind == Is::Click);
    EXPECT_EQ(click->position, glm::dvec2(12, 10));

    gestures.take(mouse(Event::Kind::ButtonDown, {10, 10}), false);
    gestures.take(mouse(Event::Kind::Move, {11, 10}), false);
    const auto first = gestures.take(mouse(Event::Kind::Move, {10, 13}), false),
               second = gestures.take(mouse(Event::Kind::Move, {11, 13}), false);
    ASSERT_TRUE(first && second && first->kind == Is::Orbit && second->kind == Is::Orbit);
    EXPECT_EQ(first->motion, glm::dvec2(0, 3)) << "since the press";
    EXPECT_EQ(second->motion, glm::dvec2(1, 0)) << "since the last move";
    EXPECT_FALSE(gestures.take(mouse(Event::Kind::ButtonUp, {11, 13}), false)) << "no click";
    EXPECT_FALSE(gestures.take(mouse(Event::Kind::Move, {30, 30}), false));
}

TEST(GesturesTest, MiddleAndShiftPan)
{
    for (const bool shift : {false, true}) {
        Gestures gestures;
        const int button = shift ? kLeftButton : kMiddleButton;
        gestures.take(mouse(Event::Kind::ButtonDown, {10, 10}, button, shift), false);
        EXPECT_FALSE(gestures.take(mouse(Event::Kind::ButtonDown, {10, 10}, kRightButton), false)) << "a second button changes nothing";
        EXPECT_FALSE(gestures.take(mouse(Event::Kind::ButtonUp, {10, 10}, kRightButton), false));
        const auto drag = gestures.take(mouse(Event::Kind::Move, {20, 10}), false);
        EXPECT_TRUE(drag && drag->kind == Gesture::Kind::Pan) << shift;
        gestures.cancel();
        EXPECT_FALSE(gestures.take(mouse(Event::Kind::Move, {30, 10}), false)) << "after a cancel";
    }
    Gestures gestures;
    const auto turn = gestures.take({.kind = Event::Kind::Scroll, .notches = 2.0}, false);
    EXPECT_TRUE(turn && turn->kind == Gesture::Kind::Dolly && turn->notches == 2.0);
}

// A gesture keeps the mouse until its button goes up, wherever that is.
TEST(GesturesTest, PanelsTakeWhatBeginsOverThem)
{
    Gestures gestures;
    EXPECT_FALSE(gestures.take({.kind = Event::Kind::Scroll, .notches = 2.0}, true));
    EXPECT_FALSE(gestures.take(mouse(Event::Kind::ButtonDown, {10, 10}), true));
    EXPECT_FALSE(gestures.take(mouse(Event::Kind::Move, {20, 10}), false));
    EXPECT_FALSE(gestures.take(mouse(Event::Kind::ButtonUp, {20, 10}), false));
    gestures.take(mouse(Event::Kind::ButtonDown, {10, 10}), false);
    EXPECT_TRUE(gestures.take(mouse(Event::Kind::Move, {20, 10}), true));
    EXPECT_FALSE(gestures.take(mouse(Event::Kind::ButtonUp, {20, 10}), true));
    EXPECT_FALSE(gestures.take(mouse(Event::Kind::Move, {30, 10}), false)) << "it has ended";
}

TEST(NoticeTest, HasATime)
{
    Notice notice;
    EXPECT_FALSE(notice.expire());
    notice.show("here");
    EXPECT_EQ(notice.text(), "here");
    EXPECT_FALSE(notice.expire()) << "not yet";
}

TEST(PanelMessagesTest, AreShownOnce)
{
    PanelMessages messages;
    EXPECT_TRUE(messages.lines().empty());
    messages.trouble = "a.gltf: broken";
    messages.notice.show(messages.trouble);
    messages.stage = "loading a.gltf";
    messages.shaders = "a.glsl:1: error: broken";
    EXPECT_EQ(messages.lines(), (std::vector<std::string>{"loading a.gltf", "a.gltf: broken", "a.glsl:1: error: broken"}));
}

// The panels that ImGui lays out in a window of this size.
struct LaidOutPanel {
    std::string name;
    ImRect place;
    ImVec2 hidden;  // what the panel is too small for
    float fontSize;
};

std::vector<LaidOutPanel> layOut(float scale, const glm::uvec2& size, const std::function<void()>& build)
{
    Gui gui(scale);
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&texels, &width, &height);
    for (int frame = 0; frame < 3; ++frame) {
        gui.frame(size, build);
    }
    std::vector<LaidOutPanel> panels;
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
        if (window->Active && !window->Hidden && window == window->RootWindow && !window->IsFallbackWindow) {
            panels.push_back({window->Name, window->Rect(), window->ScrollMax, window->CalcFontSize()});
        }
    }
    return panels;
}

// At this window's size, with as many messages as there may be.
void expectReadableHelp(float scale, const glm::uvec2& size, const std::function<void(float)>& help, float leastFontSize)
{
    for (const std::size_t count : {0, 1, 3}) {
        std::vector<std::string> messages{"wrote cornell_spheres-001.exr and .png", "compiling kernels",
                                          "A sentence of the window that is longer than its panel is wide, at least here."};
        messages.resize(count);
        const std::vector<LaidOutPanel> panels = layOut(scale, size, [&] { help(showMessages(messages)); });
        ASSERT_EQ(panels.size(), count == 0 ? 1U : 2U);
        const ImRect window(0.0F, 0.0F, static_cast<float>(size.x), static_cast<float>(size.y));
        for (const LaidOutPanel& panel : panels) {
            EXPECT_TRUE(window.Contains(panel.place))
                << panel.name << " ends at " << panel.place.Max.x << ", " << panel.place.Max.y << " with " << count << " messages";
            EXPECT_EQ(panel.hidden.x, 0.0F) << panel.name;
            EXPECT_EQ(panel.hidden.y, 0.0F) << panel.name;
            EXPECT_GE(panel.fontSize, leastFontSize) << panel.name << " with " << count << " messages";
        }
        EXPECT_FALSE(count > 0 && panels[0].place.Overlaps(panels[1].place)) << count << " messages";
    }
}

TEST(HelpTest, FitsTheWindowAndCoversNoMessage)
{
    const std::function<void(float)> ofPreview = [](float below) { showHelp(below); }, ofView = showViewHelp;
    for (const auto& help : {ofPreview, ofView}) {
        expectReadableHelp(1.0F, {512, 512}, help, 11.0F);
        expectReadableHelp(2.0F, {1024, 1024}, help, 22.0F);
        expectReadableHelp(2.0F, {512, 512}, help, 10.0F);
        expectReadableHelp(1.0F, {1280, 720}, help, 13.0F);
    }
}

// The controls are in the other corner.
TEST(GuideInsetTest, FitsIntoTheUpperRightCorner)
{
    GuideMap map;
    map.share = 0.7F;
    map.cells.resize(std::size_t{GuideMap::kColumns} * GuideMap::kRows);
    map.cells[5].density = 1e4F;
    for (const float scale : {1.0F, 2.0F}) {
        const glm::uvec2 size = static_cast<std::uint32_t>(scale) * glm::uvec2(512, 384);
        for (const auto& shown : {std::optional(map), std::optional<GuideMap>()}) {
            const std::vector<LaidOutPanel> panels = layOut(scale, size, [&] { showGuide(shown, "no guide yet"); });
            ASSERT_EQ(panels.size(), 1U);
            EXPECT_EQ(panels[0].place.Min.y, 0.0F);
            EXPECT_EQ(panels[0].place.Max.x, static_cast<float>(size.x));
            EXPECT_GT(panels[0].place.Min.x, 0.4F * static_cast<float>(size.x));
            EXPECT_LT(panels[0].place.Max.y, 0.7F * static_cast<float>(size.y));
            EXPECT_EQ(panels[0].hidden.x, 0.0F);
            EXPECT_EQ(panels[0].hidden.y, 0.0F);
        }
    }
}

// An input waits until a picture is shown that began after it.
TEST(PacerTest, InputsWaitForTheirPicture)
{
    using namespace std::chrono_literals;
    const Pacer::Time start = Pacer::Time::clock::now();
    Pacer pacer;
    pacer.spend(start, start);
    pacer.show(false);
    EXPECT_FALSE(pacer.isChanged());
    pacer.await(start);
    EXPECT_TRUE(pacer.isChanged());
    pacer.begin();
    EXPECT_FALSE(pacer.isShown());
    pacer.await(start + 10ms);
    pacer.spend(start + 20ms, start + 30ms);
    pacer.show(true);
    EXPECT_TRUE(pacer.isShown());
    EXPECT_TRUE(pacer.isChanged()) << "the camera has moved on";
    EXPECT_EQ(pacer.latency().count(), 1U);
    EXPECT_TRUE(pacer.isDue(start + 30ms, false)) << "an input waits";
    pacer.begin();
    pacer.spend(start + 40ms, start + 50ms);
    pacer.show(false);
    EXPECT_EQ(pacer.latency().count(), 2U);
    EXPECT_NEAR(pacer.latency().quantile(1.0), 0.04, 1e-9);
    EXPECT_NEAR(pacer.latency().quantile(0.0), 0.03, 1e-9);
}

// Presenting that takes 10 ms may take place every 100 ms, or every 60th of a second while something moves.
TEST(PacerTest, PresentingTakesATenthOfTheTime)
{
    using namespace std::chrono_literals;
    const Pacer::Time start = Pacer::Time::clock::now(), end = start + 10ms;
    Pacer pacer;
    pacer.spend(start, end);
    pacer.show(false);
    EXPECT_FALSE(pacer.isDue(end + 99ms, false));
    EXPECT_TRUE(pacer.isDue(end + 101ms, false));
    EXPECT_FALSE(pacer.isDue(end + 16ms, true));
    EXPECT_TRUE(pacer.isDue(end + 17ms, true));
    pacer.spend(start, start + 1ms);
    EXPECT_FALSE(pacer.isDue(start + 33ms, false));
    EXPECT_TRUE(pacer.isDue(start + 35ms, false));
}

}  // namespace
}  // namespace glim
