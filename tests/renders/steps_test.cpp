// A render in steps, from one camera after the other, gives the films of whole renders. A window shows them as files do.
#include "host/flatten/flatten_scene.hpp"
#include "host/render/composite.hpp"
#include "host/render/display.hpp"
#include "host/render/ray_tracer.hpp"
#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/harness/interface.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace glim {
namespace {

FlatCamera makeCamera(const Scene& scene, const RenderSettings& settings)
{
    return flattenCamera(scene.cameras.front(), static_cast<float>(settings.width) / static_cast<float>(settings.height));
}

// Light paths go first.
void advanceToSamples(Renderer& renderer)
{
    while (renderer.plan().pictureSamples() == 0 && renderer.advance()) {
    }
}

class StepsTest : public testing::Test {
protected:
    StepsTest()
    {
        settings.pathCapacity = 1024;  // several passes a sweep
    }
    const Scene scene = mixedScene();
    const FlatScene flat = flattened(scene);
    RenderSettings settings = squareSettings(24, 290);  // through a page, and a block begun
};

TEST_F(StepsTest, FilmsAreThoseOfWholeRenders)
{
    settings.schedule = Schedule::Persistent;
    Renderer renderer(testDevice(), flat, makeCamera(scene, settings), settings);
    int films = 0;
    std::uint64_t samples = 0;
    while (renderer.advance()) {
        const std::uint32_t count = renderer.plan().sampleCount();
        const bool whole = renderer.plan().pictureSamples() == std::uint64_t{count} * 24 * 24;
        if (renderer.plan().pictureSamples() == std::exchange(samples, renderer.plan().pictureSamples())) {
            continue;  // light paths are ahead of the camera's
        }
        if (!whole || (count > 4 && count != 32 && count != 256 && count != 290)) {
            continue;
        }
        RenderSettings same = settings;
        same.sampleEnd = count;
        same.schedule = Schedule::Wavefront;  // the renderer's is the persistent one
        const Film film = renderer.film(), expected = renderScene(scene, same);
        EXPECT_TRUE(sameBits(film, expected)) << count << " samples";
        EXPECT_EQ(film.sampleRanges, expected.sampleRanges);
        EXPECT_TRUE(film.complete);
        ++films;
    }
    EXPECT_EQ(films, 6);
    EXPECT_TRUE(renderer.plan().isDone());
}

TEST_F(StepsTest, OtherCamerasBeginAgain)
{
    settings.sampleEnd = 40;
    settings.schedule = Schedule::Persistent;
    Renderer renderer(testDevice(), flat, makeCamera(scene, settings), settings);
    renderer.advance();
    for (const glm::uvec2 size : {glm::uvec2(24, 24), glm::uvec2(7, 30), glm::uvec2(7, 30)}) {
        settings.width = size.x;
        settings.height = size.y;
        Scene moved = scene;
        moved.cameras[0].position += glm::vec3(0.1F * static_cast<float>(size.y), 0.0F, 0.0F);
        renderer.restart(makeCamera(moved, settings), size.x, size.y);
        EXPECT_EQ(renderer.plan().pictureSamples(), 0U);
        while (renderer.advance()) {
        }
        RenderSettings same = settings;
        same.schedule = Schedule::Wavefront;
        const Film film = renderer.film(), expected = renderScene(moved, same);
        EXPECT_TRUE(sameBits(film, expected));
        EXPECT_EQ(film.identity.scene, expected.identity.scene);
        EXPECT_EQ(film.identity.settings, expected.identity.settings);
    }
}

// A pass that is abandoned leaves nothing behind, neither in the film nor in the queues.
TEST_F(StepsTest, PassesThatAreGivenUpAreTracedAgain)
{
    settings.sampleEnd = 8;
    settings.course.direct = DirectLight::Lights;
    settings.course.lightSamples = 16;
    settings.uncheckedSeconds = 0.0;
    Renderer renderer(testDevice(), flat, makeCamera(scene, settings), settings);
    int calls = 0, given = 0;
    while (!renderer.plan().isDone()) {
        calls = 0;
        given += renderer.advance([&] { return ++calls != 3 || given > 4; }) ? 0 : 1;
    }
    EXPECT_EQ(given, 5);
    EXPECT_TRUE(sameBits(renderer.film(), renderScene(scene, settings)));
}

TEST_F(StepsTest, AdaptiveFilmsToo)
{
    settings.adaptive = Adaptive::Course;
    settings.sampler = Sampler::Independent;
    settings.sampleEnd = 300;
    settings.course.tolerance = 0.2F;
    settings.schedule = Schedule::Persistent;
    Renderer renderer(testDevice(), flat, makeCamera(scene, settings), settings);
    while (renderer.advance()) {
        renderer.film();
    }
    settings.schedule = Schedule::Wavefront;
    EXPECT_TRUE(sameBits(renderer.film(), renderScene(scene, settings)));
}

TEST_F(StepsTest, OneRayMeetsWhatTheCameraSees)
{
    settings.sampleEnd = 4;
    settings.adaptive = Adaptive::Off;
    settings.schedule = Schedule::Wavefront;
    Renderer renderer(testDevice(), flat, makeCamera(scene, settings), settings);
    renderer.advance();
    const Camera& camera = scene.cameras[0];
    RayTracer tracer(renderer.resources());
    const auto makePathHit = [&tracer](const PathRay& ray) { return tracer.trace(std::span(&ray, 1)).front(); };
    const PathHit hit = makePathHit({camera.position, kNoPrimitive, camera.forward});
    const PathHit miss = makePathHit({camera.position + 1e4F * camera.up, kNoPrimitive, camera.up});
    EXPECT_NE(hit.primitiveRef, kNoPrimitiveRef);
    EXPECT_EQ(miss.primitiveRef, kNoPrimitiveRef);
    while (renderer.advance()) {
    }
    EXPECT_TRUE(sameBits(renderer.film(), renderScene(scene, settings))) << "no part of the picture";
    const PixelMoments& middle = renderer.film().pixels[12 * 24 + 12];
    EXPECT_NEAR(hit.t, middle.depth, 0.2F * middle.depth);
}

// --- what a window shows ---

void draw(Display& display, const Renderer& renderer, Aov aov, const DisplayRange& range, const Look& look)
{
    EXPECT_TRUE(display.draw(renderer, aov, range, look, kDrawnInColor, [] { return true; }));
}

std::vector<Rgb8> shownBy(Display& display)
{
    const KernelLayout layout(testDevice(), {{kBindResults, BufferKind::Storage}}, 2 * sizeof(uint), {kBindPicture});
    const Kernel kernel(layout, test_kernels::read_picture, {{kSpecWorkgroup, 64}});
    const uint size[] = {display.picture().width(), display.picture().height()};
    Buffer pixels(testDevice(), "test's pixels", BufferKind::Storage, std::uint64_t{4} * size[0] * size[1]);
    const Bindings bindings(layout, {{kBindResults, &pixels}}, {{kBindPicture, &display.picture()}});
    Commands commands(testDevice());
    commands.dispatch(kernel, bindings, std::as_bytes(std::span(size)), (size[0] * size[1] + 63) / 64);
    commands.submitAndWait();
    std::vector<Rgb8> colors;
    for (const uint pixel : download<uint>(pixels, std::size_t{size[0]} * size[1])) {
        colors.push_back({static_cast<std::uint8_t>(pixel), static_cast<std::uint8_t>(pixel >> 8), static_cast<std::uint8_t>(pixel >> 16)});
    }
    return colors;
}

// Of eight bits; float and double may round a half to either side.
int largestDifference(const std::vector<Rgb8>& a, const std::vector<Rgb8>& b)
{
    int largest = a.size() == b.size() ? 0 : 255;
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            largest = std::max(largest, std::abs(int{a[i][c]} - int{b[i][c]}));
        }
    }
    return largest;
}

TEST_F(StepsTest, AWindowShowsWhatFilesHold)
{
    Display display(testDevice());
    display.resize({24, 24}, {0, 0}, {24, 24});
    for (const std::uint32_t samples : {1U, 40U, 290U}) {
        RenderSettings one = settings;
        one.sampleEnd = samples;
        Renderer light(testDevice(), flat, makeCamera(scene, one), one);
        one.aov = Aov::BvhSteps;
        one.bounces = 0;
        Renderer steps(testDevice(), flat, makeCamera(scene, one), one);
        while (light.advance() || steps.advance()) {
        }
        for (const Aov aov : {Aov::Radiance, Aov::Normal, Aov::Depth, Aov::Albedo, Aov::SampleCount, Aov::BvhSteps}) {
            Renderer& renderer = aov == Aov::BvhSteps ? steps : light;
            const Film film = renderer.film();
            const DisplayRange range = computeRange(film, aov);
            draw(display, renderer, aov, range, {0.5, Tone::Neutral});
            std::vector<Rgb8> expected;
            for (const PixelMoments& pixel : film.pixels) {
                expected.push_back(displayColor(pixel, aov, range, {0.5, Tone::Neutral}));
            }
            EXPECT_LE(largestDifference(shownBy(display), expected), 1) << "aov " << static_cast<int>(aov) << ", " << samples;
        }
    }
}

// Of light; in other layers they are surfaces like others.
TEST_F(StepsTest, AWindowShowsTheCompositeOfShadowCatchers)
{
    Scene caught = scene;
    caught.materials.front().isCatcher = true;
    const FlatScene flatCaught = flattened(caught);
    settings.catcher = true;
    Display display(testDevice());
    display.resize({24, 24}, {0, 0}, {24, 24});
    for (const std::uint32_t samples : {1U, 40U, 290U}) {
        settings.sampleEnd = samples;
        Renderer renderer(testDevice(), flatCaught, makeCamera(caught, settings), settings);
        while (renderer.advance()) {
        }
        const Film film = renderer.film();
        const std::vector<PixelMoments> picture = pictureOf(film);
        EXPECT_GT(std::ranges::count_if(picture, [](const PixelMoments& pixel) { return pixel.alpha < 0.5F; }), 50) << samples;
        for (const Aov aov : {Aov::Radiance, Aov::Normal, Aov::Depth, Aov::Albedo}) {
            const DisplayRange range = computeRange(film, aov);
            draw(display, renderer, aov, range, {0.5, Tone::None});
            std::vector<Rgb8> expected;
            for (const PixelMoments& pixel : aov == Aov::Radiance ? picture : film.pixels) {
                expected.push_back(displayColor(pixel, aov, range, {0.5, Tone::None}));
            }
            EXPECT_LE(largestDifference(shownBy(display), expected), 1) << "aov " << static_cast<int>(aov) << ", " << samples;
        }
    }
}

// A pixel without a sample keeps what it showed before: nothing flashes black.
TEST_F(StepsTest, AWindowKeepsTheCoarsePictureUnderTheFine)
{
    Display display(testDevice());
    display.resize({24, 24}, {0, 0}, {24, 24});
    settings.sampleEnd = 1;
    settings.pathCapacity = 64;
    Renderer renderer(testDevice(), flat, makeCamera(scene, settings), settings);
    renderer.restart(makeCamera(scene, settings), 3, 3);
    advanceToSamples(renderer);
    draw(display, renderer, Aov::Albedo, {}, {});
    const std::vector<Rgb8> coarse = shownBy(display);
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        EXPECT_EQ(coarse[i], coarse[i / 24 / 8 * 8 * 24 + i % 24 / 8 * 8]) << "blocks of eight";
    }
    renderer.restart(makeCamera(scene, settings), 24, 24);
    advanceToSamples(renderer);
    ASSERT_EQ(renderer.plan().pictureSamples(), 64U);
    draw(display, renderer, Aov::Albedo, {}, {});
    const std::vector<Rgb8> mixed = shownBy(display);
    const Film film = renderer.film();
    for (std::size_t i = 0; i < mixed.size(); ++i) {
        EXPECT_EQ(mixed[i], i < 64 ? displayColor(film.pixels[i], Aov::Albedo, {}, {}) : coarse[i]) << i;
    }
}

}  // namespace
}  // namespace glim
