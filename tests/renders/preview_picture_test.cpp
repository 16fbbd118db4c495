// The window shows and writes what `glim render` gives.
#include "host/preview/idle_denoiser.hpp"
#include "host/preview/scene_pictures.hpp"
#include "host/render/film_file.hpp"
#include "host/render/film_pictures.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/preview_fixture.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace glim::test {
namespace {

TEST_F(PreviewTest, ShowsAndWritesWhatARenderGives)
{
    const Pixels shown = windowAtWriting(screen, "0 samples 8\n0 key P\n", {"--spp", "8"});
    EXPECT_TRUE(sameBits(film(1), render("--spp 8")));
    EXPECT_EQ(picture(1), rendered());
    EXPECT_EQ(countOthers(shown, rendered()), 0);
}

TEST_F(PreviewTest, ShowsTheTonesThatFilesHave)
{
    for (const std::string look : {"--tone neutral", "--tone agx --exposure 1.5", "--tone agx --exposure auto"}) {
        std::istringstream words(look);
        std::vector<std::string> options{std::istream_iterator<std::string>(words), {}};
        options.insert(options.end(), {"--spp", "8"});
        const Pixels shown = windowAtWriting(screen, "0 samples 8\n0 key P\n", options);
        render("--spp 8");
        const Pixels plain = rendered();
        render("--spp 8 " + look);
        EXPECT_EQ(picture(1), rendered()) << look;
        EXPECT_EQ(countOthers(shown, rendered()), 0) << look;
        EXPECT_GT(countOthers(shown, plain), static_cast<int>(width * height / 2)) << look;
        removePictures();
    }
}

// Past the end of a page, where the host takes over the samples. Not denoised, however long it takes.
TEST_F(PreviewTest, ShowsManySamples)
{
    width = 24;
    height = 18;
    const Pixels shown = windowAtWriting(screen, "0 key N\n0 samples 300\n0 key P\n", {"--spp", "300"});
    EXPECT_TRUE(sameBits(film(1), render("--spp 300")));
    EXPECT_EQ(countOthers(shown, rendered()), 0);
}

// Options of sampling, of adaptive sampling and of the camera are a render's.
TEST_F(PreviewTest, TakesTheOptionsOfARender)
{
    const char* const kOptions[] = {
        "--spp 4 --seed 7 --sampler independent --bounces 2 --direct lights --light-samples 2 --roulette fixed:0.8",
        "--adaptive course --tolerance 0.2 --batch 8 --max-spp 64",
        "--samples 32:40 --clamp-indirect 1 --paths indirect --accelerator none --intersector moller-trumbore",
        "--spp 2 --fov 50 --zoom 0.75",
        "--spp 2 --camera framed --fov 25",
        "--spp 3 --look-from 0,1.2,3 --look-at 0,1,0 --zoom 1.5 --lens-radius 0.05 --focal-distance 3 --environment 1,0.5,0.25",
    };
    for (const char* options : kOptions) {
        std::istringstream words(options);
        const std::vector<std::string> list{std::istream_iterator<std::string>(words), {}};
        run("0 samples 2000000000\n0 key P\n0 close\n", list);
        const Film made = film(1);
        const Film expected = render(options);
        EXPECT_TRUE(sameBits(made, expected)) << options;
        EXPECT_EQ(made.identity.settings, expected.identity.settings);
        EXPECT_EQ(picture(1), rendered()) << options;
        removePictures();
    }
}

TEST_F(PreviewTest, WritesAlphaWhereTheBackgroundIsHidden)
{
    const char* const kOptions = "--spp 2 --environment 1,1,1 --environment-background off --zoom 0.5";
    std::istringstream words(kOptions);
    run("0 samples 2000000000\n0 key P\n0 close\n", {std::istream_iterator<std::string>(words), {}});
    EXPECT_TRUE(sameBits(film(1), render(kOptions)));
    const std::string bytes = readFileBytes(folder / "cornell_spheres-001.png");
    EXPECT_EQ(bytes, readFileBytes(folder / "r.png"));
    EXPECT_EQ(bytes.at(25), 6) << "RGBA";
}

// Wherever the camera is, C prints the options with which `glim render` gives the same bits.
TEST_F(PreviewTest, PrintsTheOptionsOfItsCamera)
{
    const char* const kMoves[] = {
        "0 drag left 10,10 40,30\n",
        "0 drag middle 50,50 20,40\n0 scroll 2\n",
        "0 key F\n0 scroll -1\n",
        "0 press W\n0.2 release W\n0 press E\n0 press A\n0.1 release A\n0 release E\n",
        "0 key F\n0 drag left 0,0 90,0\n0 key R\n0 resize 50x70\n",
    };
    for (const char* moves : kMoves) {
        const GlimRun session = run(std::string("0 samples 1\n") + moves + "0.1 key C\n0 samples 4\n0 key P\n0 key escape\n",
                                    {"--spp", "4", "--lens-radius", "0.01", "--focal-distance", "3"});
        const std::string options = firstLine(session.out);
        ASSERT_EQ(options.rfind("--camera 0", 0), 0U) << session.out;
        EXPECT_NE(session.out.find("\"cameras\":[{\"type\":\"perspective\""), std::string::npos) << session.out;
        const Film expected = render("--spp 4 " + options);
        EXPECT_TRUE(sameBits(film(1), expected)) << moves << options;
        EXPECT_EQ(film(1).identity.settings, expected.identity.settings);
        removePictures();
    }
}

TEST_F(PreviewTest, NeverFlashesBlack)
{
    std::string script = "0 samples 2\n0 key P\n";
    for (int i = 0; i < 30; ++i) {
        script += "0.04 drag left 10,10 16,12\n0.04 drag left 16,12 10,10\n";
        script += i % 5 == 4 ? "0.1 key V\n" : i % 5 == 2 ? "0.1 key +\n0 key -\n" : "";
    }
    const Watched seen = watch(12, script);
    // With one sample a pixel, .565 of the window has light from the first view; a flash would leave none.
    EXPECT_GT(seen.minLight, 0.5) << "of the window, all through";
    EXPECT_GE(seen.pictures.size(), 12U);
}

TEST_F(PreviewTest, ShowsTheFlight)
{
    const Watched seen = watch(20, "0 samples 2\n0 key P\n0 press W\n80 release W\n", {"--spp", "1"});
    EXPECT_GE(seen.pictures.size(), 20U) << "while the key is down";
}

// The mouse moves more often than pictures are made.
TEST_F(PreviewTest, ShowsPicturesThroughALongDrag)
{
    std::string script = "0 samples 1\n0 key P\n";
    for (int i = 0; i < 20000; ++i) {
        script += "0.003 drag left 10,10 13,10\n";
    }
    const Watched seen = watch(20, script, {"--spp", "1"});
    EXPECT_GE(seen.pictures.size(), 20U);
}

// On a display with small pixels the panels have twice the height and width.
TEST_F(PreviewTest, PanelsGrowWithTheDensityOfTheDisplay)
{
    width = 800;
    height = 600;
    panels = true;
    const auto covered = [&](int density) {
        const VirtualScreen display(24, density);
        const Pixels window = windowAtWriting(display, "0 samples 1\n0 key P\n", {"--spp", "1"});
        const int others = countOthers(window, picture(1));
        removePictures();
        return static_cast<double>(others);
    };
    const double once = covered(96);
    EXPECT_GT(once, 100 * 100);
    EXPECT_NEAR(covered(192) / once, 4.0, 0.5);
}

void enterScene(ScenePictures& pictures, const LoadOptions& options)
{
    auto loaded = std::make_unique<LoadedScene>(test::sceneFile("cornell_spheres.gltf"), options);
    updateScene(loaded->prepared, loaded->file, std::nullopt, SplitRule::Sah);
    pictures.enter(std::move(loaded));
}

Film filmOf(ScenePictures& pictures)
{
    pictures.show(pictures.scene().scene.cameras.front(), {8, 6});
    while (pictures.shown().sampleCount() == 0 || !pictures.shown().isDone()) {
        pictures.shown().refine(false, nullptr);
    }
    return pictures.shown().renderer().film();
}

void edit(ScenePictures& pictures, const std::vector<Edit>& edits)
{
    LoadOptions options;
    options.edits = edits;
    pictures.change(options, SplitRule::Sah);
}

// Other kernels, too: the walls get a coat, and one moves.
TEST(ScenePicturesTest, AnEditShowsTheSceneThatItMakes)
{
    RenderSettings settings;
    settings.sampleEnd = 2;
    const std::vector<Edit> edits{{"/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", "1"},
                                  {"/nodes/4/translation", "[0.125, 0, 0]"}};
    int compiled = 0;
    ScenePictures pictures(testDevice(), settings, {}, [&compiled] { ++compiled; }), edited(testDevice(), settings, {}, [] {});
    enterScene(pictures, {});
    const Film before = filmOf(pictures);
    EXPECT_EQ(compiled, 1) << "at the start";
    edit(pictures, {edits[1]});
    filmOf(pictures);
    EXPECT_EQ(compiled, 1) << "the same kernels serve it";
    edit(pictures, {});
    EXPECT_THROW(edit(pictures, {{"/materials/99/alphaCutoff", "1"}}), InputError);
    EXPECT_TRUE(sameBits(filmOf(pictures), before));
    edit(pictures, edits);
    EXPECT_EQ(compiled, 2) << "a coat needs others";
    LoadOptions options;
    options.edits = edits;
    enterScene(edited, options);
    const Film after = filmOf(pictures);
    EXPECT_TRUE(sameBits(after, filmOf(edited)));
    EXPECT_FALSE(sameBits(after, before));
    edit(pictures, {});
    EXPECT_TRUE(sameBits(filmOf(pictures), before));
}

TEST(ScenePicturesTest, AnEditMakesACatcher)
{
    RenderSettings settings;
    settings.sampleEnd = 2;
    settings.halves = true;
    const std::vector<Edit> edits{{"/materials/0/extras/shadowCatcher", "true"}};
    int compiled = 0;
    ScenePictures pictures(testDevice(), settings, {}, [&compiled] { ++compiled; }), catching(testDevice(), settings, {}, [] {});
    enterScene(pictures, {});
    const Film before = filmOf(pictures);
    EXPECT_TRUE(before.catcher.empty());
    edit(pictures, edits);
    const Film after = filmOf(pictures);
    EXPECT_EQ(compiled, 2) << "kernels that follow two paths";
    EXPECT_EQ(after.catcher.size(), after.pixels.size());
    EXPECT_FALSE(pictures.settings().halves);
    LoadOptions options;
    options.catchers = {"white"};
    enterScene(catching, options);
    EXPECT_TRUE(sameBits(after, filmOf(catching)));
    edit(pictures, edits);
    filmOf(pictures);
    EXPECT_EQ(compiled, 2);
    edit(pictures, {});
    EXPECT_TRUE(sameBits(filmOf(pictures), before));
    EXPECT_TRUE(pictures.settings().halves);
}

// One second after the last move, at the latest with the second page of samples. N shows the noisy picture again, and a move ends it.
TEST_F(PreviewTest, DenoisesWhatIsLeftAlone)
{
    const std::string wait = "0 samples 512\n6 ";
    const std::vector<std::string> options{"--spp", "512"};
    const Film plain = render("--spp 512");
    const Pixels noisy = rendered();
    const Pixels shown = windowAtWriting(screen, wait + "key P\n", options);
    EXPECT_TRUE(sameBits(film(1), plain));
    const auto denoised = readDenoised(folder / "cornell_spheres-001.exr");
    ASSERT_TRUE(denoised);
    Look look;
    writeFilmPicture(folder / "denoised.png", showDenoised(plain, *denoised), Aov::Radiance, look);
    EXPECT_EQ(picture(1), decodePng(folder / "denoised.png"));
    EXPECT_EQ(countOthers(shown, picture(1)), 0);
    EXPECT_GT(countOthers(picture(1), noisy), static_cast<int>(width * height / 20));
    removePictures();
    EXPECT_EQ(countOthers(windowAtWriting(screen, wait + "key N\n0 key P\n", options), noisy), 0);
    EXPECT_EQ(picture(1), noisy);
    EXPECT_FALSE(readDenoised(folder / "cornell_spheres-001.exr"));
    removePictures();
    run(wait + "drag left 10,10 14,10\n0 samples 1\n0 key P\n0 close\n", options);
    EXPECT_FALSE(readDenoised(folder / "cornell_spheres-001.exr"));
}

// In pieces, it is what the denoiser makes of the same halves at once; both if these begin with the picture and if they begin late.
TEST(IdleDenoiserTest, GivesTheDenoisedPictureOfTheHalves)
{
    for (const bool late : {false, true}) {
        RenderSettings settings;
        settings.halves = true;
        settings.halvesLate = late;
        settings.sampleEnd = late ? 1U << 20 : 512;
        ScenePictures pictures(testDevice(), settings, {}, [] {});
        enterScene(pictures, {});
        int compiled = 0, pieces = 0;
        IdleDenoiser denoiser(testDevice(), [&compiled] { ++compiled; });
        std::optional<FilmHalves> halves;
        const auto workUntil = [&](const auto& isReached) {
            pictures.show(pictures.scene().scene.cameras.front(), {32, 24});
            denoiser.restart();
            EXPECT_EQ(denoiser.result(), nullptr);
            for (const auto start = Clock::now(); !isReached() && secondsSince(start) < 60.0;) {
                const bool worked = denoiser.isWorking();
                int asked = 0;
                if (denoiser.work(pictures.shown(), [&asked] { return ++asked == 1; })) {  // one dispatch
                    ++pieces;
                } else {
                    pictures.shown().refine(false, nullptr);
                }
                if (!worked && denoiser.isWorking()) {
                    halves = *pictures.shown().renderer().films().halves();
                }
            }
        };
        workUntil([&] { return denoiser.isWorking(); });
        workUntil([&] { return denoiser.result() != nullptr; });
        ASSERT_NE(denoiser.result(), nullptr) << late;
        EXPECT_EQ(compiled, 1);
        EXPECT_GE(pieces, 2 * (2 * kWindowWidth + 1)) << "the kernels of both halves";
        EXPECT_EQ(denoiser.result()->samples, halves->films()[0].pixels[0].count + halves->films()[1].pixels[0].count);
        NlMeans nlMeans(testDevice());
        const auto atOnce = denoiseHalves(*halves, [&](const Film& film) { return nlMeans.denoise(film, [] { return true; }); });
        ASSERT_TRUE(atOnce);
        EXPECT_EQ(denoiser.result()->picture.radiance, atOnce->radiance);
        EXPECT_EQ(denoiser.result()->picture.measured.mse.value, atOnce->measured.mse.value);
        EXPECT_LT(atOnce->measured.mse.value, atOnce->measured.noisyMse);
        const std::vector<std::string> lines = describe(denoiser, false);
        ASSERT_EQ(lines.size(), 3U);
        EXPECT_TRUE(lines[1].starts_with("measured RMSE ")) << "also while the noisy picture is shown";
        EXPECT_TRUE(lines[2].starts_with("without denoising "));
    }
}

// The picture of steps and that of light are of the same view, whichever layer was shown while the camera moved.
TEST(ScenePicturesTest, LayersShowThePresentView)
{
    const glm::uvec2 size(8, 6);
    int compiled = 0;
    ScenePictures pictures(testDevice(), {}, {}, [&compiled] { ++compiled; });
    EXPECT_TRUE(pictures.isEmpty());
    const auto enter = [&pictures] {
        enterScene(pictures, {});
        return pictures.scene().scene.cameras.front();
    };
    Camera camera = enter();
    pictures.show(camera, size);
    EXPECT_FALSE(pictures.choose(Aov::Normal, camera, size, false));
    EXPECT_EQ(compiled, 1);
    EXPECT_TRUE(pictures.choose(Aov::BvhSteps, camera, size, false));
    EXPECT_EQ(compiled, 2) << "kernels that count steps";
    EXPECT_TRUE(pictures.shown().isFresh());
    EXPECT_FALSE(pictures.choose(Aov::Depth, camera, size, false)) << "the camera has not moved";
    EXPECT_TRUE(pictures.choose(Aov::BvhSteps, camera, size, false));
    camera.position.z += 0.5F;
    pictures.show(camera, size);
    EXPECT_TRUE(pictures.choose(Aov::Radiance, camera, size, false));
    EXPECT_EQ(pictures.shown().camera().position, camera.position);
    EXPECT_TRUE(pictures.choose(Aov::BvhSteps, camera, size, true));
    EXPECT_TRUE(pictures.choose(Aov::Radiance, camera, size, false)) << "it had moved before";
    pictures.choose(Aov::BvhSteps, camera, size, false);
    pictures.show(enter(), size);
    EXPECT_EQ(pictures.layer(), Aov::Radiance) << "another scene has no such kernels yet";
}

}  // namespace
}  // namespace glim::test
