// Plans of samples: each sample is taken once and in order, however the passes are cut and wherever a render stops and goes on.
#include "host/render/sample_plan.hpp"
#include "host/render/film_halves.hpp"
#include "shaders/shared/limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <random>

namespace glim {
namespace {

// Stands in for the device and the films: for each pixel, the samples taken of it in order; and the same that are folded.
struct Taken {
    explicit Taken(const RenderSettings& of)
        : settings(of),
          samples(of.pixelCount())
    {
        chooseAll();
    }

    void add(const CameraPass& pass)
    {
        for (std::uint32_t i = 0; i < pass.pixelCount; ++i) {
            const PixelStart& start = chosen.at(pass.tile).at(pass.firstPixel + i);
            for (std::uint32_t k = 0; k < pass.sampleCount; ++k) {
                samples[start.pixel].push_back(start.sample + pass.firstSample + k);
            }
        }
    }
    void add(const LightPass& pass)
    {
        EXPECT_EQ(pass.firstSample, lightEnd);
        EXPECT_LE(pass.firstSample + pass.sampleCount, blockEnd(pass.firstSample)) << "of one block";
        lightEnd = pass.firstSample + pass.sampleCount;
    }

    void chooseAll()
    {
        std::vector<PixelStart> all(settings.pixelCount());
        for (std::uint32_t i = 0; i < all.size(); ++i) {
            all[i].pixel = i;
        }
        choose(all);
    }
    void choose(const std::vector<PixelStart>& pixels)
    {
        chosen.assign((settings.pixelCount() + settings.tileSize() - 1) / settings.tileSize(), {});
        for (const PixelStart& each : pixels) {
            chosen[each.pixel / settings.tileSize()].push_back(each);
        }
    }
    // Whose index is not a multiple of 3, if they have fewer samples than `end`.
    std::vector<std::uint32_t> test()
    {
        std::vector<PixelStart> left;
        for (std::uint32_t i = 0; i < samples.size(); ++i) {
            if (i % 3 != 0) {
                left.push_back({i, 0});
            }
        }
        choose(left);
        return countByTile(left, settings);
    }

    RenderSettings settings;
    std::vector<std::vector<PixelStart>> chosen;  // of each tile
    std::vector<std::vector<std::uint32_t>> samples;
    std::uint32_t lightEnd = 0;
    int folds = 0, commonFolds = 0;
};

// A render by a plan. Pixels with higher indices get larger shares.
struct PlannedRender {
    PlannedRender(const RenderSettings& of, bool tracesLight)
        : settings(of),
          light(tracesLight),
          plan(of, tracesLight),
          taken(of)
    {
        taken.lightEnd = of.sampleBegin;
        if (of.halves) {
            halves.emplace(of);
        }
    }

    // False at the end.
    bool advance()
    {
        while (plan.beginRound()) {
            carryOutTasks();
        }
        if (plan.isDone()) {
            return false;
        }
        const std::uint32_t paths = 1 + static_cast<std::uint32_t>(random() % 200);
        if (const auto pass = plan.nextLight(paths)) {
            taken.add(*pass);
            plan.finish(*pass);
            return true;
        }
        const CameraPass pass = plan.next(paths);
        EXPECT_GE(pass.pixelCount, 1U);
        EXPECT_TRUE(pass.pixelCount == 1 || pass.paths() <= paths);
        taken.add(pass);
        if (light && !isNeighbours(settings.adaptive)) {
            EXPECT_GE(taken.lightEnd, pass.firstSample + pass.sampleCount) << "light paths go before";
        }
        plan.finish(pass, paths);
        carryOutTasks();
        return true;
    }

    // What a render loses that stops now and goes on from its checkpoint. False if there is none.
    bool interrupt()
    {
        std::optional<SampleProgress> progress = plan.progress();
        if (!progress) {
            return false;
        }
        Film film;
        progress->describe(film, settings.sampleBegin);
        const std::uint32_t end = film.sampleRanges.front().second;
        for (std::uint32_t i = 0; i < taken.samples.size(); ++i) {
            const std::uint32_t common = i < progress->pixelsAhead ? end : progress->sample;
            const std::uint32_t begin = progress->adaptive ? progress->adaptive->chosenBegin : 0xFFFFFFFF;
            const std::uint32_t own = progress->adaptive ? begin + progress->adaptive->chosen[i] : 0;
            std::erase_if(taken.samples[i], [&](std::uint32_t s) { return s < begin ? s >= common : s >= own; });
        }
        taken.chooseAll();
        taken.lightEnd = progress->lightSample;
        EXPECT_EQ(progress->sample % blockSamples(progress->sample),
                  progress->sample == settings.sampleBegin ? settings.sampleBegin % blockSamples(progress->sample) : 0);
        const std::uint64_t before = std::accumulate(taken.samples.begin(), taken.samples.end(), std::uint64_t{0},
                                                     [](std::uint64_t n, const auto& s) { return n + s.size(); });
        plan = SamplePlan(settings, light);
        EXPECT_TRUE(plan.canResume(*progress));
        plan.resume(*std::move(progress), 100);
        carryOutTasks();
        EXPECT_EQ(plan.resumedSamples(), before);
        EXPECT_EQ(plan.pictureSamples(), before);
        return true;
    }

    void carryOutTasks()
    {
        while (const auto task = plan.takeTask()) {
            switch (*task) {
            case PlanTask::ChooseAllPixels: taken.chooseAll(); break;
            case PlanTask::ChoosePixels: taken.choose(plan.sweep()); break;
            case PlanTask::TestPixels: plan.choose(taken.test()); break;
            case PlanTask::TakeHalves: halves->take(page(), plan.endOfSamples(), false); break;
            case PlanTask::TakeFirstHalf: halves->takeChosen(0, page()); break;
            case PlanTask::TakeSecondHalf: halves->takeChosen(1, page()); break;
            case PlanTask::FoldCommon: beginPage(taken.commonFolds); break;
            case PlanTask::Fold: beginPage(taken.folds); break;
            case PlanTask::Allocate: {
                std::vector<double> shares(settings.pixelCount());
                for (std::size_t i = 0; i < shares.size(); ++i) {
                    shares[i] = 2.0 * static_cast<double>(i) / static_cast<double>(shares.size() - 1);
                }
                plan.allocate(shares, halves ? &*halves : nullptr, 100);
            }
            }
        }
    }

    // As many samples of each pixel as are not folded. One is as bright as its index.
    FilmMoments page() const
    {
        FilmMoments page;
        for (std::size_t i = 0; i < taken.samples.size(); ++i) {
            PixelMoments pixel{};
            for (std::size_t k = folded.empty() ? 0 : folded[i]; k < taken.samples[i].size(); ++k) {
                pixel = foldMoments(pixel, {.count = 1, .blocks = 1, .mean = glm::vec3(static_cast<float>(taken.samples[i][k]))});
            }
            page.pixels.push_back(pixel);
        }
        return page;
    }
    void beginPage(int& count)
    {
        ++count;
        folded.clear();
        for (const std::vector<std::uint32_t>& samples : taken.samples) {
            folded.push_back(samples.size());
        }
        if (halves) {
            halves->beginPage();
        }
    }

    RenderSettings settings;
    bool light;
    std::mt19937 random{1};
    SamplePlan plan;
    Taken taken;
    std::optional<FilmHalves> halves;
    std::vector<std::size_t> folded;  // of each pixel's samples
};

RenderSettings makeSettings(std::uint32_t begin, std::uint32_t end)
{
    RenderSettings settings;
    settings.width = 9;
    settings.height = 5;
    settings.tilePixels = 10;
    settings.sampleBegin = begin;
    settings.sampleEnd = end;
    return settings;
}

std::vector<std::uint32_t> range(std::uint32_t begin, std::uint32_t end)
{
    std::vector<std::uint32_t> samples(end - begin);
    std::iota(samples.begin(), samples.end(), begin);
    return samples;
}

TEST(SamplePlanTest, UniformRendersTakeEachSampleOnceAndInOrder)
{
    for (const auto& [begin, end] : {std::pair{0U, 1U}, {0U, 20U}, {0U, 600U}, {200U, 700U}, {128U, 129U}}) {
        for (const bool light : {false, true}) {
            PlannedRender render(makeSettings(begin, end), light);
            while (render.advance()) {
            }
            for (const std::vector<std::uint32_t>& samples : render.taken.samples) {
                EXPECT_EQ(samples, range(begin, end));
            }
            EXPECT_EQ(render.taken.lightEnd, light ? end : begin);
            EXPECT_EQ(render.plan.sampleCount(), end - begin);
            EXPECT_EQ(render.plan.pictureSamples(), 45U * (end - begin));
            EXPECT_EQ(render.plan.plannedSamples(), render.plan.pictureSamples());
            EXPECT_EQ(render.taken.folds, static_cast<int>(end / kPageSamples - begin / kPageSamples));
            Film film;
            render.plan.describe(film);
            EXPECT_TRUE(film.complete);
            EXPECT_EQ(film.sampleRanges.front(), std::pair(begin, end));
        }
    }
}

// A render that is stopped early covers its picture evenly.
TEST(SamplePlanTest, SweepsGrowToBlocks)
{
    RenderSettings settings = makeSettings(0, 300);
    const auto sweepsOf = [&] {
        SamplePlan plan(settings, false);
        std::vector<std::uint32_t> ends;
        while (!plan.isDone()) {
            const CameraPass pass = plan.next(1U << 20);
            plan.finish(pass, 1U << 20);
            while (plan.takeTask()) {
            }
            if (ends.empty() || ends.back() != pass.firstSample + pass.sampleCount) {
                ends.push_back(pass.firstSample + pass.sampleCount);
            }
        }
        return ends;
    };
    EXPECT_EQ(sweepsOf(), (std::vector<std::uint32_t>{1, 2, 4, 8, 16, 32, 64, 128, 256, 300}));
    settings.halves = true;
    const std::vector<std::uint32_t> ends = sweepsOf();
    for (std::uint32_t half = FilmHalves::nextEnd(0); half < 300; half = FilmHalves::nextEnd(half)) {
        EXPECT_NE(std::ranges::find(ends, half), ends.end()) << half;
    }
}

// Whatever was not in whole blocks is taken again, and nothing else.
TEST(SamplePlanTest, InterruptedRendersTakeEachSampleOnce)
{
    for (const std::uint32_t every : {1U, 2U, 3U, 7U, 20U}) {
        for (const auto& [begin, end] : {std::pair{0U, 400U}, {200U, 500U}}) {
            PlannedRender render(makeSettings(begin, end), true);
            int interruptions = 0;
            for (std::uint32_t pass = 1; render.advance(); ++pass) {
                interruptions += pass % every == 0 && interruptions < 40 && render.interrupt() ? 1 : 0;
            }
            EXPECT_GT(interruptions, 3) << every;
            for (const std::vector<std::uint32_t>& samples : render.taken.samples) {
                EXPECT_EQ(samples, range(begin, end));
            }
            EXPECT_EQ(render.taken.lightEnd, end);
        }
    }
}

// Each pixel has the samples that all share, and then its own, which add up to the mean that was asked for.
void expectAllocated(const PlannedRender& render, std::uint32_t mean)
{
    std::uint64_t all = 0;
    std::uint32_t most = 0;
    Film film;
    render.plan.describe(film);
    ASSERT_EQ(film.sampleRanges.size(), 2U);
    const auto [begin, end] = film.sampleRanges.back();
    for (const std::vector<std::uint32_t>& samples : render.taken.samples) {
        std::vector<std::uint32_t> sorted = range(0, film.sampleRanges.front().second);
        const auto ofItsOwn = static_cast<std::uint32_t>(samples.size() - sorted.size());
        const std::vector<std::uint32_t> rest = range(begin, begin + ofItsOwn);
        sorted.insert(sorted.end(), rest.begin(), rest.end());
        std::vector<std::uint32_t> found = samples;
        std::ranges::sort(found);
        EXPECT_EQ(found, sorted);
        EXPECT_EQ(ofItsOwn % kBlockSamples, 0U);
        EXPECT_LE(begin + ofItsOwn, end);
        most = std::max(most, ofItsOwn);
        all += samples.size();
    }
    EXPECT_LE(film.sampleRanges.front().second, begin);
    EXPECT_GT(most, 0U);
    EXPECT_NEAR(static_cast<double>(all) / 45.0, mean, 0.5 * kBlockSamples / 45.0);
    EXPECT_EQ(render.plan.pictureSamples(), all);
    EXPECT_TRUE(film.complete);
}

TEST(SamplePlanTest, AdaptiveRendersHaveTheirMean)
{
    for (const std::uint32_t mean : {192U, 640U}) {
        RenderSettings settings = makeSettings(0, mean);
        settings.adaptive = Adaptive::Neighbours;
        PlannedRender render(settings, true);
        while (render.advance()) {
        }
        expectAllocated(render, mean);
        EXPECT_EQ(render.taken.lightEnd, mean / kBlockSamples * kBlockSamples);
        EXPECT_GT(render.taken.folds, 3) << "rounds";
    }
}

TEST(SamplePlanTest, InterruptedAdaptiveRendersHaveTheSame)
{
    for (const std::uint32_t every : {5U, 17U, 40U}) {
        RenderSettings settings = makeSettings(0, 640);
        settings.adaptive = Adaptive::Neighbours;
        PlannedRender render(settings, true);
        int interruptions = 0;
        for (std::uint32_t pass = 1; render.advance(); ++pass) {
            interruptions += pass % every == 0 && interruptions < 40 && render.interrupt() ? 1 : 0;
        }
        EXPECT_GT(interruptions, 3);
        expectAllocated(render, 640);
        PlannedRender whole(settings, true);
        while (whole.advance()) {
        }
        for (std::size_t i = 0; i < whole.taken.samples.size(); ++i) {
            EXPECT_EQ(render.taken.samples[i].size(), whole.taken.samples[i].size()) << i;
        }
    }
}

// Chosen pixels' blocks go to the smaller half. What all pixels share may differ by a block behind that, less half a one. Nothing else
// changes.
TEST(SamplePlanTest, AdaptiveRendersHaveHalves)
{
    for (const std::uint32_t mean : {192U, 640U, 1024U}) {
        RenderSettings settings = makeSettings(0, mean);
        settings.adaptive = Adaptive::Neighbours;
        PlannedRender plain(settings, true);
        while (plain.advance()) {
        }
        settings.halves = true;
        PlannedRender render(settings, true);
        while (render.advance()) {
        }
        expectAllocated(render, mean);
        EXPECT_EQ(render.taken.lightEnd, plain.taken.lightEnd);
        EXPECT_EQ(render.taken.folds, plain.taken.folds);
        const auto& [first, second] = render.halves->films();
        for (std::size_t i = 0; i < render.taken.samples.size(); ++i) {
            std::vector<std::uint32_t> samples = render.taken.samples[i];
            std::ranges::sort(samples);
            std::vector<std::uint32_t> expected = plain.taken.samples[i];
            std::ranges::sort(expected);
            EXPECT_EQ(samples, expected);
            const double a = first.pixels[i].count, b = second.pixels[i].count;
            EXPECT_EQ(a + b, static_cast<double>(samples.size()));
            EXPECT_LE(std::abs(a - b), kBlockSamples + kBlockSamples / 2) << i;
            const double sum = a * static_cast<double>(first.pixels[i].mean.r) + b * static_cast<double>(second.pixels[i].mean.r);
            EXPECT_NEAR(sum / std::accumulate(samples.begin(), samples.end(), 0.0), 1.0, 1e-5) << "each sample once";
        }
    }
    EXPECT_EQ(blocksOfFirstHalf(64, 64, 3), 1U);
    EXPECT_EQ(blocksOfFirstHalf(96, 32, 1), 0U);
    EXPECT_EQ(blocksOfFirstHalf(96, 160, 2), 1U);
    EXPECT_EQ(blocksOfFirstHalf(512, 64, 2), 0U);
    EXPECT_EQ(blocksOfFirstHalf(64, 512, 2), 2U);
    EXPECT_EQ(blocksOfFirstHalf(64, 512, 6), 5U);
}

// The course's rule takes pixels out at the ends of batches.
TEST(SamplePlanTest, StoppedPixelsGetNoMore)
{
    RenderSettings settings = makeSettings(0, 100);
    settings.adaptive = Adaptive::Course;
    settings.course.batch = 24;
    PlannedRender render(settings, false);
    while (render.advance()) {
        EXPECT_FALSE(render.plan.progress());
    }
    for (std::size_t i = 0; i < render.taken.samples.size(); ++i) {
        EXPECT_EQ(render.taken.samples[i], range(0, i % 3 == 0 ? 24 : 100)) << i;
    }
    EXPECT_EQ(render.plan.plannedSamples(), render.plan.pictureSamples());
}

TEST(SamplePlanTest, TargetsAreJudgedAtEndsOfBlocks)
{
    PlannedRender render(makeSettings(0, 2048), false);
    render.plan.expectTarget();
    EXPECT_EQ(render.plan.plannedSamples(), 45U * minSamplesForError(0));
    std::vector<std::uint32_t> judged;
    while (render.advance()) {
        if (render.plan.isJudgedNow()) {
            judged.push_back(render.plan.sampleCount());
            EXPECT_FALSE(render.plan.judge(1.5));
            EXPECT_EQ(render.plan.plannedSamples(), render.plan.pictureSamples() * 3 / 2);
            EXPECT_FALSE(render.plan.isJudgedNow()) << "once";
        }
    }
    ASSERT_GT(judged.size(), 5U);
    for (std::size_t i = 0; i < judged.size(); ++i) {
        EXPECT_TRUE(endsBlock(judged[i])) << judged[i];
        EXPECT_TRUE(i == 0 || judged[i] >= 1.1 * judged[i - 1]);
    }
    EXPECT_TRUE(render.plan.judge(1.0));
}

}  // namespace
}  // namespace glim
