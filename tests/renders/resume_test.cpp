// Renders that stop and go on from their films: the bits are those of renders without an interruption.
#include "host/flatten/flatten_scene.hpp"
#include "host/measure/error_estimate.hpp"
#include "host/render/film_file.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <new>
#include <random>

namespace glim {
namespace {

// Renders in pieces, each of which begins with the file of the one before and ends after some passes.
class Pieces {
public:
    Pieces(const Scene& scene, const RenderSettings& settings, const StoppingCriterion& criterion = nullptr)
        : flat_(flattened(scene)),
          camera_(flattenCamera(scene.cameras.front(), 1.0F)),
          renderer_(testDevice(), flat_, camera_, settings),
          criterion_(criterion)
    {}

    Film renderAtOnce()
    {
        restart();
        return renderer_.render([](const RenderProgress&) { return true; }, criterion_);
    }

    // `passesOf`: of each piece.
    Film renderInPieces(const std::function<int()>& passesOf)
    {
        for (pieces = 1;; ++pieces) {
            restart();
            if (std::filesystem::exists(file_)) {
                std::optional<Checkpoint> checkpoint = readStoredFilm(file_).checkpoint;
                EXPECT_TRUE(checkpoint && renderer_.plan().canResume(checkpoint->progress));
                renderer_.resume(*std::move(checkpoint));
            }
            int left = passesOf();
            bool ended = false;
            std::optional<Checkpoint> checkpoint;
            const auto observe = [&](const RenderProgress& now) {
                left -= now.betweenPasses ? 1 : 0;
                ended = left <= 0;
                return !ended;
            };
            const Film film = renderer_.render(observe, criterion_, [&] { checkpoint = renderer_.checkpoint(); });
            if (renderer_.plan().isDone() || !ended) {
                end = film.sampleRanges.front().second;
                return film;
            }
            if (checkpoint) {
                apart += checkpoint->page.pixels.empty() ? 0 : 1;
                ahead += checkpoint->progress.pixelsAhead > 0 ? 1 : 0;
                choosing += isChoosing(checkpoint->progress) ? 1 : 0;
                second += isChoosing(checkpoint->progress) && checkpoint->progress.adaptive->second ? 1 : 0;
                writeFilm(file_, film, *checkpoint);
                EXPECT_TRUE(sameBits(readFilm(file_), film));
            }
        }
    }

    const FilmHalves* halves() const { return renderer_.films().halves(); }

    int pieces = 0, apart = 0, ahead = 0, choosing = 0, second = 0;
    std::uint32_t end = 0;  // of the samples

private:
    void restart() { renderer_.restart(camera_, renderer_.settings().width, renderer_.settings().height); }

    FlatScene flat_;
    FlatCamera camera_;
    Renderer renderer_;
    StoppingCriterion criterion_;
    test::ScratchFolder folder_;
    std::filesystem::path file_ = folder_ / "film.exr";
};

// Of several tiles, and passes of a few hundred samples.
RenderSettings inSmallPasses(std::uint32_t side, std::uint32_t spp)
{
    RenderSettings settings = squareSettings(side, spp);
    settings.tilePixels = 100;
    settings.pathCapacity = 1024;
    return settings;
}

std::function<int()> randomPasses(int most)
{
    return [random = std::mt19937(1), most]() mutable { return 1 + static_cast<int>(random() % static_cast<unsigned>(most)); };
}

// A render in pieces against one at once.
void expectTheBitsOfOneRun(Pieces& pieces, int passes)
{
    const Film whole = pieces.renderAtOnce(), film = pieces.renderInPieces(randomPasses(passes));
    EXPECT_TRUE(sameBits(film, whole));
    EXPECT_EQ(film.sampleRanges, whole.sampleRanges);
    EXPECT_EQ(film.complete, whole.complete);
    EXPECT_EQ(film.splats.empty(), whole.splats.empty());
    EXPECT_GT(pieces.pieces, 4);
}

class ResumeTest : public ::testing::TestWithParam<Schedule> {};

// The mixed scene has light paths.
TEST_P(ResumeTest, UniformRendersHaveTheBitsOfOneRun)
{
    for (const auto& [begin, end] : {std::pair{0U, 900U}, std::pair{200U, 700U}}) {
        RenderSettings settings = inSmallPasses(16, end);
        settings.sampleBegin = begin;
        settings.schedule = GetParam();
        Pieces pieces(mixedScene(), settings);
        expectTheBitsOfOneRun(pieces, 40);
        EXPECT_GT(pieces.apart, 3);
        EXPECT_GT(pieces.ahead, 3);
    }
}

// No pixel is ahead, so a piece that ends within a block loses it.
TEST_P(ResumeTest, HalvesHaveTheBitsOfOneRun)
{
    for (const auto& [begin, end] : {std::pair{0U, 700U}, std::pair{100U, 500U}}) {
        RenderSettings settings = inSmallPasses(16, end);
        settings.sampleBegin = begin;
        settings.schedule = GetParam();
        settings.halves = true;
        Pieces pieces(mixedScene(), settings);
        pieces.renderAtOnce();
        const std::array<Film, 2> whole = pieces.halves()->films();
        expectTheBitsOfOneRun(pieces, 60);
        EXPECT_GT(pieces.apart, 0);
        EXPECT_EQ(pieces.ahead, 0);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_TRUE(sameBits(pieces.halves()->films()[i], whole[i]));
        }
    }
}

// A piece may end within the first and the second half of chosen pixels' samples.
TEST_P(ResumeTest, HalvesOfAdaptiveRendersHaveTheBitsOfOneRun)
{
    RenderSettings settings = inSmallPasses(16, 640);
    settings.adaptive = Adaptive::Neighbours;
    settings.schedule = GetParam();
    const Film plain = Pieces(mixedScene(), settings).renderAtOnce();
    settings.halves = true;
    Pieces pieces(mixedScene(), settings);
    EXPECT_TRUE(sameBits(pieces.renderAtOnce(), plain));
    const std::array<Film, 2> whole = pieces.halves()->films();
    expectTheBitsOfOneRun(pieces, 40);
    EXPECT_GT(pieces.choosing, 2);
    EXPECT_GT(pieces.second, 0);
    EXPECT_LT(pieces.second, pieces.choosing);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE(sameBits(pieces.halves()->films()[i], whole[i]));
    }
}

TEST_P(ResumeTest, RowsHaveTheBitsOfThePicture)
{
    RenderSettings settings = inSmallPasses(16, 300);
    settings.schedule = GetParam();
    const Film picture = Pieces(mixedScene(), settings).renderAtOnce();
    Film expected;
    expected.pixels.assign(picture.pixels.begin() + 3 * 16, picture.pixels.begin() + 15 * 16);
    expected.splats.assign(picture.splats.begin() + 3 * 16, picture.splats.begin() + 15 * 16);
    settings.rows = {3, 15};  // of two tiles
    Pieces pieces(mixedScene(), settings);
    const Film rows = pieces.renderAtOnce();
    EXPECT_TRUE(sameBits(rows, expected));
    EXPECT_NE(computeDigest(rows), computeDigest(picture));
    expectTheBitsOfOneRun(pieces, 20);
}

TEST_P(ResumeTest, AdaptiveRendersHaveTheBitsOfOneRun)
{
    RenderSettings settings = inSmallPasses(16, 640);
    settings.adaptive = Adaptive::Neighbours;
    settings.schedule = GetParam();
    Pieces pieces(mixedScene(), settings);
    expectTheBitsOfOneRun(pieces, 40);
    EXPECT_GT(pieces.choosing, 2);
    EXPECT_GT(pieces.ahead, 2);
}

INSTANTIATE_TEST_SUITE_P(Schedules, ResumeTest, ::testing::Values(Schedule::Wavefront, Schedule::Persistent));

// The error is judged at the same numbers of samples.
TEST(ResumeTargetTest, StopsWhereOneRunDoes)
{
    const auto criterion = [](const Film& film) { return estimateError(film).value().errors.relMse / 6e-4; };
    for (const Adaptive adaptive : {Adaptive::Off, Adaptive::Neighbours}) {
        RenderSettings settings = inSmallPasses(16, 8192);
        settings.adaptive = adaptive;
        Pieces pieces(mixedScene(), settings, criterion);
        expectTheBitsOfOneRun(pieces, 30);
        EXPECT_GT(pieces.end, 200U) << "a target that is met later tells more";
        EXPECT_LT(pieces.end, 8192U);
    }
}

// It is unknown then, and the render goes on.
TEST(ResumeTargetTest, MemoryThatIsMissingForTheErrorLosesNoSample)
{
    const auto criterion = [](const Film&) -> double { throw std::bad_alloc(); };
    Pieces pieces(mixedScene(), squareSettings(8, 512), criterion);
    EXPECT_TRUE(sameBits(pieces.renderAtOnce(), renderScene(mixedScene(), squareSettings(8, 512))));
}

// Films without a checkpoint go on if they end with a page, or lie within one and end with a block.
TEST(ResumeFilmTest, AnyFilmThatEndsWithAPageGoesOn)
{
    for (const std::uint32_t end : {64U, 512U, 640U}) {
        RenderSettings settings = squareSettings(12, end);
        settings.schedule = Schedule::Persistent;
        const Scene scene = mixedScene();
        std::optional<Checkpoint> checkpoint = makeCheckpoint(renderScene(scene, settings));
        ASSERT_EQ(checkpoint.has_value(), end != 640U) << end;
        if (!checkpoint) {
            continue;
        }
        settings.sampleEnd = 800;
        const FlatScene flat = flattened(scene);
        Renderer renderer(testDevice(), flat, flattenCamera(scene.cameras.front(), 1.0F), settings);
        renderer.resume(*std::move(checkpoint));
        EXPECT_TRUE(sameBits(renderer.render([](const RenderProgress&) { return true; }), renderScene(scene, settings))) << end;
        EXPECT_EQ(renderer.statistics().samples, 144U * (800U - end));
    }
}

// One with halves goes on without them, also before the chosen pixels' blocks of the second half, and within these.
TEST(ResumeFilmTest, HalvesAreNoHindrance)
{
    RenderSettings settings = inSmallPasses(16, 256);
    settings.adaptive = Adaptive::Neighbours;
    settings.schedule = Schedule::Persistent;
    const Film plain = renderScene(mixedScene(), settings);
    RenderSettings halved = settings;
    halved.halves = true;
    const FlatScene flat = flattened(mixedScene());
    const FlatCamera camera = flattenCamera(mixedScene().cameras.front(), 1.0F);
    for (const std::size_t half : {0U, 1U}) {
        Renderer first(testDevice(), flat, camera, halved);
        std::optional<Checkpoint> checkpoint;
        first.render([&](const RenderProgress&) { return first.plan().chosenHalf() != half; }, nullptr,
                     [&] { checkpoint = first.checkpoint(); });
        ASSERT_TRUE(checkpoint && isChoosing(checkpoint->progress));
        EXPECT_EQ(checkpoint->progress.adaptive->second, half == 1);
        Renderer second(testDevice(), flat, camera, settings);
        second.resume(*std::move(checkpoint));
        EXPECT_TRUE(sameBits(second.render([](const RenderProgress&) { return true; }), plain)) << half;
    }
}

// Nor does one for which fewer samples are asked than some pixels have, or one of another way to sample.
TEST(ResumeFilmTest, CheckpointsBeyondTheEndDoNot)
{
    RenderSettings settings = squareSettings(4, 300);
    const FlatScene flat = flattened(mixedScene());
    const Renderer renderer(testDevice(), flat, flattenCamera(mixedScene().cameras.front(), 1.0F), settings);
    Checkpoint checkpoint;
    checkpoint.progress.sample = 256;
    EXPECT_TRUE(renderer.plan().canResume(checkpoint.progress));
    checkpoint.progress.pixelsAhead = 1;
    EXPECT_FALSE(renderer.plan().canResume(checkpoint.progress)) << "that pixel has the samples up to 384";
    checkpoint.progress.pixelsAhead = 0;
    checkpoint.progress.adaptive.emplace();
    EXPECT_FALSE(renderer.plan().canResume(checkpoint.progress));
}

TEST(ResumeFilmTest, FilmsThatLackSamplesDoNotGoOn)
{
    RenderSettings settings = squareSettings(4, 256);
    settings.schedule = Schedule::Persistent;
    Film film = renderScene(mixedScene(), settings);
    film.complete = false;
    EXPECT_FALSE(makeCheckpoint(film));
    film.complete = true;
    EXPECT_TRUE(makeCheckpoint(film));
    film.sampleRanges = {{0, 128}, {256, 384}};
    EXPECT_FALSE(makeCheckpoint(film));
    film.sampleRanges = {{0, 100}};
    EXPECT_FALSE(makeCheckpoint(film)) << "within a block";
    film.sampleRanges = {{128, 384}};
    EXPECT_FALSE(makeCheckpoint(film)) << "over two pages";
}

}  // namespace
}  // namespace glim
