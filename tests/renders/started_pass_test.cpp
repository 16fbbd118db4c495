// Passes that are started while the device traces the one before.
#include "host/flatten/flatten_scene.hpp"
#include "host/render/pass_tracer.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <array>

namespace glim {
namespace {

constexpr std::uint32_t kSide = 24, kSamples = 4;

// Passes are short enough to be started ahead, whatever they take.
RenderSettings shortPasses(std::uint32_t side, std::uint32_t samples, Schedule schedule)
{
    RenderSettings settings = squareSettings(side, samples);
    settings.schedule = schedule;
    settings.uncheckedSeconds = 1e9;
    return settings;
}

class StartedPassTest : public testing::TestWithParam<Schedule> {
protected:
    StartedPassTest()
    {
        const Scene scene = mixedScene();
        resources_.emplace(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), shortPasses(kSide, 64, GetParam()));
        tile_ = resources_->makeTile(0, kSide * kSide);
        tracer_.emplace(*resources_);
    }

    // Number `i`: other samples of all pixels, in a block of their own.
    Pass pass(std::uint32_t i) const
    {
        Pass pass = tile_->pass();
        pass.pixelCount = tile_->count();
        pass.firstSample = i * kSamples;
        pass.sampleCount = kSamples;
        pass.accumulate = kEndsBlock;
        return pass;
    }

    std::vector<PixelMoments> pages() const { return tile_->readPages(); }

    // After passes 0 to `count` - 1, one by one.
    std::vector<PixelMoments> pagesAfter(std::uint32_t count)
    {
        tile_->clear();
        for (std::uint32_t i = 0; i < count; ++i) {
            tracer_->trace(*tile_, pass(i), nullptr);
        }
        const std::vector<PixelMoments> after = pages();
        tile_->clear();
        return after;
    }

    static bool areSame(const std::vector<PixelMoments>& a, const std::vector<PixelMoments>& b)
    {
        return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(PixelMoments)) == 0;
    }

    std::optional<RenderResources> resources_;
    std::unique_ptr<Tile> tile_;
    std::optional<PassTracer> tracer_;
};

TEST_P(StartedPassTest, HasTheSamplesOfPassesOneByOne)
{
    const std::vector<PixelMoments> expected = pagesAfter(3);
    const auto first = tracer_->start(*tile_, pass(0)), second = tracer_->start(*tile_, pass(1));
    EXPECT_FALSE(tracer_->end(*first).wasLate);
    const auto third = tracer_->start(*tile_, pass(2));
    EXPECT_FALSE(tracer_->end(*second).wasLate);
    const PassTracer::Ended ended = tracer_->end(*third);
    EXPECT_FALSE(ended.wasLate);
    EXPECT_GT(ended.seconds.longest, 0.0);
    EXPECT_GE(ended.seconds.total, ended.seconds.longest);
    EXPECT_TRUE(areSame(pages(), expected));
}

// As many rounds as the late pass needs are known afterwards.
TEST_P(StartedPassTest, IsLeftOutIfTheOneBeforeIsLateAndStartedAgain)
{
    const std::vector<PixelMoments> one = pagesAfter(1), two = pagesAfter(2);
    ASSERT_FALSE(areSame(one, two));
    resources_->history.rounds = GetParam() == Schedule::Wavefront ? 2 : 0;
    const auto first = tracer_->start(*tile_, pass(0)), leftOut = tracer_->start(*tile_, pass(1));
    EXPECT_TRUE(tracer_->end(*first).wasLate);
    EXPECT_TRUE(areSame(pages(), one));
    leftOut->recording.finish();
    EXPECT_TRUE(areSame(pages(), one));
    const auto again = tracer_->start(*tile_, pass(1));
    EXPECT_FALSE(tracer_->end(*again).wasLate);
    EXPECT_TRUE(areSame(pages(), two));
}

// The late pass and the one behind it leave no trace: passes that are not started ahead go on as usual.
TEST_P(StartedPassTest, LetsOthersGoOnAfterALateOne)
{
    const std::vector<PixelMoments> expected = pagesAfter(3);
    resources_->history.rounds = GetParam() == Schedule::Wavefront ? 1 : 0;
    const auto first = tracer_->start(*tile_, pass(0)), leftOut = tracer_->start(*tile_, pass(1));
    tracer_->end(*first);
    leftOut->recording.finish();
    tracer_->trace(*tile_, pass(1), nullptr);
    tracer_->trace(*tile_, pass(2), nullptr);
    EXPECT_TRUE(areSame(pages(), expected));
}

TEST_P(StartedPassTest, IsUsedWherePassesAreShortAndTimed)
{
    EXPECT_FALSE(tracer_->startsAhead()) << "how long passes take is not known yet";
    tracer_->trace(*tile_, pass(0), nullptr);
    EXPECT_EQ(tracer_->startsAhead(), testDevice().description().nanosecondsPerTick > 0.0F);
    resources_->history.rounds = kMaxRounds + 1;
    EXPECT_FALSE(tracer_->startsAhead()) << "it would always be late";
}

// With room for a ninth of the picture's pixels, and paths whose lengths vary: some passes are late.
TEST_P(StartedPassTest, FilmsHaveTheBitsOfPassesOneByOne)
{
    const Scene scene = mixedScene();
    RenderSettings settings = shortPasses(48, 96, GetParam());
    settings.pathCapacity = 256;
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = flattenCamera(scene.cameras.front(), 1.0F);
    Renderer ahead(testDevice(), flat, camera, settings), oneByOne(testDevice(), flat, camera, settings);
    const Film film = ahead.render([](const RenderProgress&) { return true; });
    while (oneByOne.advance()) {
    }
    EXPECT_TRUE(sameBits(film, oneByOne.film()));
    EXPECT_EQ(ahead.statistics().samples, oneByOne.statistics().samples);
    EXPECT_EQ(ahead.statistics().cameraAndBounceRays, oneByOne.statistics().cameraAndBounceRays);
}

// A pass that the device has not ended when the observer ends the render is part of the film.
TEST_P(StartedPassTest, IsInTheFilmOfARenderThatIsEnded)
{
    const Scene scene = mixedScene();
    RenderSettings settings = shortPasses(32, 1024, GetParam());
    settings.pathCapacity = 4096;
    Renderer renderer(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), settings);
    int passes = 0;
    const Film film = renderer.render([&](const RenderProgress& now) { return !now.betweenPasses || ++passes < 20; });
    std::uint64_t samples = 0;
    for (const PixelMoments& pixel : film.pixels) {
        samples += pixel.count;
    }
    EXPECT_EQ(samples, renderer.plan().pictureSamples());
    EXPECT_EQ(samples, renderer.statistics().samples);
}

INSTANTIATE_TEST_SUITE_P(Schedules, StartedPassTest, testing::Values(Schedule::Wavefront, Schedule::Persistent),
                         [](const testing::TestParamInfo<Schedule>& schedule) { return std::string(getName(schedule.param)); });

}  // namespace
}  // namespace glim
