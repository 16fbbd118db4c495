#include "host/cli/commands.hpp"
#include "host/error.hpp"
#include "host/render/film_file.hpp"
#include "host/render/merge_films.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/simulated_film.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

using test::expectRefusal;
using test::Parts;
using test::sameBits;
using test::ScratchFolder;
using test::simulateFilm;
using Range = std::pair<std::uint32_t, std::uint32_t>;

MergedFilm mergeRanges(const std::vector<Range>& ranges)
{
    const ScratchFolder folder;
    std::vector<std::filesystem::path> files;
    for (const auto& [begin, end] : ranges) {
        files.push_back(folder.path() / (std::to_string(begin) + ".exr"));
        writeFilm(files.back(), simulateFilm(begin, end));
    }
    return mergeFilms(files);
}

void expectSingleRun(const std::vector<Range>& ranges, Range whole)
{
    const MergedFilm merged = mergeRanges(ranges);
    EXPECT_TRUE(merged.exact);
    EXPECT_EQ(merged.film.sampleRanges, std::vector<Range>{whole});
    EXPECT_TRUE(sameBits(merged.film.pixels, simulateFilm(whole.first, whole.second).pixels));
}

TEST(Merge, PagesGiveTheBitsOfTheSingleRun)
{
    expectSingleRun({{0, 256}, {256, 512}}, {0, 512});
    expectSingleRun({{512, 768}, {0, 256}, {256, 512}}, {0, 768});      // in any order
    expectSingleRun({{0, 768}, {768, 1024}, {1024, 1100}}, {0, 1100});  // a long run first, part of a page last
    expectSingleRun({{100, 512}, {512, 768}}, {100, 768});              // from the middle of a page
    expectSingleRun({{40, 300}}, {40, 300});
}

TEST(Merge, OtherRangesGiveTheSingleRunUpToRoundingAndSaySo)
{
    const std::vector<std::vector<Range>> merges = {{{0, 256}, {256, 768}}, {{0, 64}, {64, 256}, {256, 512}}, {{0, 384}, {384, 640}}};
    for (const auto& ranges : merges) {
        const MergedFilm merged = mergeRanges(ranges);
        EXPECT_FALSE(merged.exact);
        const Film single = simulateFilm(ranges.front().first, ranges.back().second);
        EXPECT_FALSE(sameBits(merged.film.pixels, single.pixels)) << "the promise could be wider";
        for (std::size_t i = 0; i < single.pixels.size(); ++i) {
            EXPECT_EQ(merged.film.pixels[i].count, single.pixels[i].count);
            EXPECT_NEAR(merged.film.pixels[i].mean.x, single.pixels[i].mean.x, 1e-6F * single.pixels[i].mean.x);
            EXPECT_EQ(merged.film.pixels[i].depth, single.pixels[i].depth);
        }
    }
}

TEST(Merge, AFilmThatEndedEarlyGivesUpThePromise)
{
    for (const bool earlier : {false, true}) {
        const ScratchFolder folder;
        Film first = simulateFilm(0, 256), second = simulateFilm(256, 512);
        Film& ended = earlier ? first : second;
        ended.complete = false;
        ended.pixels.back() = PixelMoments{};
        writeFilm(folder / "a.exr", first);
        writeFilm(folder / "b.exr", second);
        const MergedFilm merged = mergeFilms({folder / "a.exr", folder / "b.exr"});
        EXPECT_FALSE(merged.exact);
        EXPECT_FALSE(merged.film.complete);
        EXPECT_EQ(merged.film.pixels.back().count, 256U);
    }
}

TEST(Merge, KeepsNoPromiseBeyondAGap)
{
    const MergedFilm merged = mergeRanges({{0, 256}, {512, 768}});
    EXPECT_FALSE(merged.exact);
    EXPECT_EQ(merged.film.sampleRanges, (std::vector<Range>{{0, 256}, {512, 768}}));
}

TEST(Merge, AFilmMergedToRoundingNeverClaimsExactnessLater)
{
    MergedFilm rounded = mergeRanges({{0, 256}, {256, 768}});
    EXPECT_EQ(rounded.film.sampleRanges, (std::vector<Range>{{0, 256}, {256, 768}}));
    const Film next = simulateFilm(768, 1024);
    EXPECT_FALSE(continuesExactly(rounded.film, next));
    EXPECT_FALSE(planMerge({rounded.film, next}, {"a", "b"}).exact);
    EXPECT_FALSE(planMerge({rounded.film}, {"a"}).exact);
}

TEST(Merge, AddsUpTimeAndDevices)
{
    Film film = simulateFilm(0, 256), same = simulateFilm(256, 512), other = simulateFilm(512, 768);
    other.device = "another";
    foldFilm(film, same);
    EXPECT_EQ(film.device, "a device");
    foldFilm(film, other);
    EXPECT_EQ(film.device, "a device; another");
    EXPECT_DOUBLE_EQ(film.seconds, 25.6 + 25.6 + 25.6);
}

TEST(Merge, ContinuesExactlyOnlyByOnePageFromItsBeginning)
{
    auto range = [](std::uint32_t begin, std::uint32_t end) {
        Film film;
        film.sampleRanges = {{begin, end}};
        return film;
    };
    EXPECT_TRUE(continuesExactly(range(0, 256), range(256, 512)));
    EXPECT_TRUE(continuesExactly(range(7, 512), range(512, 513)));
    EXPECT_FALSE(continuesExactly(range(0, 256), range(256, 513)));
    EXPECT_FALSE(continuesExactly(range(0, 255), range(256, 512)));
    EXPECT_FALSE(continuesExactly(range(0, 32), range(32, 64)));
    EXPECT_FALSE(continuesExactly(range(256, 512), range(0, 256)));
    EXPECT_FALSE(continuesExactly(Film{}, range(0, 256)));
}

// What `glim merge ...` says on stderr.
std::string runMerge(std::vector<std::string> arguments)
{
    CommandLine line("", "", "");
    addMerge(line);
    arguments.insert(arguments.begin(), "merge");
    testing::internal::CaptureStderr();
    try {
        line.run(arguments);
    } catch (...) {
        testing::internal::GetCapturedStderr();
        throw;
    }
    return testing::internal::GetCapturedStderr();
}

TEST(MergeCommand, WritesTheFilmAndSaysHowExactItIs)
{
    const ScratchFolder folder;
    const std::string a = folder / "a.exr", b = folder / "b.exr", c = folder / "c.exr", png = folder / "c.png";
    writeFilm(a, simulateFilm(0, 256));
    writeFilm(b, simulateFilm(256, 512));
    EXPECT_NE(runMerge({b, a, "-o", c, "--png", png, "--exposure", "-1"}).find("samples 0:512: bit-identical to a single run"),
              std::string::npos);
    EXPECT_TRUE(sameBits(readFilm(c).pixels, simulateFilm(0, 512).pixels));
    EXPECT_TRUE(std::filesystem::exists(png));
    writeFilm(b, simulateFilm(512, 2048));
    EXPECT_NE(runMerge({c, b, "-o", c}).find("samples 0:512 512:2048: equal to a single run up to rounding"), std::string::npos);
}

TEST(MergeCommand, RefusesAndWritesNothing)
{
    const ScratchFolder folder;
    const std::string a = folder / "a.exr", c = folder / "c.exr";
    writeFilm(a, simulateFilm(0, 256));
    expectRefusal<InputError>([&] { runMerge({a, a, "-o", c}); }, MessageId::Duplicate, {.file = a, .place = "samples", .value = "0:256"});
    expectRefusal<InputError>([&] { runMerge({a, "missing.exr", "-o", c}); }, MessageId::FileMissing, {.file = "missing.exr"});
    const std::string misnamed = folder / "c.tif";
    expectRefusal<UsageError>(
        [&] {
            runMerge({"missing.exr", "-o", misnamed});
        },
        MessageId::UnknownFormat, {.place = "--output", .value = misnamed, .expected = ".exr, or a picture's"});
    EXPECT_THROW(runMerge({a}), UsageError);
    EXPECT_THROW(runMerge({a, "-o", c, "--exposure", "1"}), UsageError);
    EXPECT_THROW(runMerge({a, "-o", c, "--png", "c.png", "--exposure", "101"}), UsageError);
    EXPECT_EQ(folder.entries(), 1);
}

class MergeRefusal : public testing::Test {
protected:
    void expectRefused(MessageId id, Parts parts) const
    {
        parts.file = "b.exr";
        expectRefusal<InputError>([&] { planMerge({a, b}, {"a.exr", "b.exr"}); }, id, parts);
    }
    Film a = simulateFilm(0, 256), b = simulateFilm(256, 512);
};

TEST_F(MergeRefusal, OfAnotherSize)
{
    b.height = 6;
    expectRefused(MessageId::Mismatch, {.place = "size", .value = "7x6", .expected = "7x5"});
}

// Rows 0:5 and 5:10 of a picture.
class MergeRows : public MergeRefusal {
protected:
    MergeRows()
    {
        b = simulateFilm(0, 256);
        a.rowsBelow = b.rowsAbove = 5;
    }
};

TEST_F(MergeRows, AreOneRunIfTheyHaveTheSameSamplesAndArithmetic)
{
    EXPECT_TRUE(planMerge({a, b}, {"a.exr", "b.exr"}).exact);
    EXPECT_NE(computeDigest(a), computeDigest(b));
    EXPECT_EQ(planMerge({b, a}, {"b.exr", "a.exr"}).order, (std::vector<std::size_t>{1, 0}));
    b.arithmetic = "another";
    EXPECT_FALSE(planMerge({a, b}, {"a.exr", "b.exr"}).exact);
    b = a;
    b.rowsAbove = 5;
    b.rowsBelow = 0;
    b.complete = false;
    EXPECT_FALSE(planMerge({a, b}, {"a.exr", "b.exr"}).exact);
}

TEST_F(MergeRows, AreRefusedIfSomeAreMissingOrTwiceThere)
{
    a.rowsBelow = 6;
    b.rowsAbove = 6;
    expectRefused(MessageId::Mismatch, {.place = "rows 6:11", .value = "rows 0:5"});
    a.rowsBelow = 4;
    b.rowsAbove = 4;
    expectRefused(MessageId::Mismatch, {.place = "rows 4:9", .value = "rows 0:5"});
    b.rowsBelow = 4;
    b.rowsAbove = 0;
    b.height = 5;
    expectRefused(MessageId::Duplicate, {.place = "samples", .value = "0:256"});
}

TEST_F(MergeRows, AreRefusedIfTheirSamplesDiffer)
{
    b.sampleRanges = {{0, 300}};
    expectRefused(MessageId::Mismatch, {.place = "rows 5:10", .value = "0:300", .expected = "0:256"});
}

TEST_F(MergeRows, OfAPictureOfAnotherSize)
{
    b.rowsBelow = 1;
    expectRefused(MessageId::Mismatch, {.place = "size", .value = "7x11", .expected = "7x10"});
}

TEST_F(MergeRefusal, OfAnotherScene)
{
    b.identity.scene = "77aa";
    b.sceneFile = "scenes/other.gltf";
    expectRefused(
        MessageId::Mismatch,
        {.place = "scene, camera or environment", .value = "\"77aa\" (scenes/other.gltf)", .expected = "\"3f2a\" (scenes/box.gltf)"});
}

TEST_F(MergeRefusal, OfAnotherSeed)
{
    b.identity.seed = 2;
    expectRefused(MessageId::Mismatch, {.place = "seed", .value = "2", .expected = "1"});
}

TEST_F(MergeRefusal, OfAnotherSetting)
{
    b.identity.settings = "bounces=64 sampler=independent";
    expectRefused(MessageId::Mismatch, {.place = "setting", .value = "\"sampler=independent\"", .expected = "\"sampler=sobol\""});
    b.identity.settings = "bounces=64 sampler=sobol clamp=3";
    expectRefused(MessageId::Mismatch, {.place = "setting", .value = "\"clamp=3\"", .expected = "\"\""});
}

TEST_F(MergeRefusal, OfOverlappingSamples)
{
    b.sampleRanges = {{255, 300}};
    expectRefused(MessageId::Duplicate, {.place = "samples", .value = "255:256"});
    a.sampleRanges = {{0, 1000}, {2000, 3000}};
    b.sampleRanges = {{1500, 1600}, {2500, 2600}};
    expectRefused(MessageId::Duplicate, {.place = "samples", .value = "2500:2600"});
    b.sampleRanges = a.sampleRanges;
    expectRefused(MessageId::Duplicate, {.place = "samples", .value = "0:1000"});
}

}  // namespace
}  // namespace glim
