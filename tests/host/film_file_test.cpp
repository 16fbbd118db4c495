#include "host/render/film_file.hpp"
#include "host/error.hpp"
#include "host/image/exr.hpp"
#include "host/measure/compare_images.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/guide_records.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/simulated_film.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace glim {
namespace {

using test::expectRefusal;
using test::readFileBytes;
using test::sameBits;
using test::ScratchFolder;
using test::simulateFilm;

TEST(FilmFile, ReadsBackEveryBit)
{
    const ScratchFolder folder;
    Film film = simulateFilm(100, 700, 4294967295U);
    film.sampleRanges = {{0, 32}, {100, 700}};
    film.pixels[3].mean = glm::vec3(-0.0F, 1e-42F, 3e38F);
    film.pixels[4] = PixelMoments{};
    film.pixels[5].count = 0xFFFFFFFFU;
    film.pixels[5].blocks = (1U << 24) + 1;
    film.seconds = 1.0 / 3.0;
    film.complete = false;
    film.showsBackground = false;
    const FilmDigests digests = writeFilm(folder / "a.exr", film);
    EXPECT_EQ(digests.film, computeDigest(film));
    EXPECT_EQ(digests.pixels, computePixelsDigest(film));
    const Film back = readFilm(folder / "a.exr");
    EXPECT_EQ(back.width, film.width);
    EXPECT_EQ(back.height, film.height);
    EXPECT_TRUE(sameBits(back.pixels, film.pixels));
    EXPECT_EQ(back.sampleRanges, film.sampleRanges);
    EXPECT_EQ(back.identity.scene, film.identity.scene);
    EXPECT_EQ(back.identity.settings, film.identity.settings);
    EXPECT_EQ(back.identity.seed, film.identity.seed);
    EXPECT_EQ(back.seconds, film.seconds);
    EXPECT_FALSE(back.complete);
    EXPECT_FALSE(back.showsBackground);
    EXPECT_EQ(back.device, film.device);
    EXPECT_EQ(back.sceneFile, film.sceneFile);
    const Film header = readFilmHeader(folder / "a.exr");
    EXPECT_TRUE(header.pixels.empty());
    EXPECT_EQ(header.sampleRanges, film.sampleRanges);
}

// With light paths.
Film filmWithSplats()
{
    Film film = simulateFilm(0, 128);
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const float x = static_cast<float>(i + 1) / 7.0F;
        film.splats.push_back({128, 3, {x, 2.0F * x, 0.1F}, {x * x, x, 3.0F}, 0.5F * x});
    }
    return film;
}

TEST(FilmFile, ReadsBackEveryBitOfSplats)
{
    const ScratchFolder folder;
    const Film film = filmWithSplats();
    writeFilm(folder / "a.exr", film);
    const Film back = readFilm(folder / "a.exr");
    EXPECT_TRUE(sameBits(back.pixels, film.pixels));
    ASSERT_EQ(back.splats.size(), film.splats.size());
    EXPECT_EQ(std::memcmp(back.splats.data(), film.splats.data(), film.splats.size() * sizeof(SplatMoments)), 0);
}

// With light groups, of camera paths or of both kinds.
Film filmWithGroups(bool splats)
{
    Film film = splats ? filmWithSplats() : simulateFilm(0, 128);
    film.identity.settings += " light-groups=key,others";
    const auto fill = [&film](GroupMoments& groups, float scale) {
        groups = GroupMoments(2, film.pixels.size());
        for (std::size_t i = 0; i < groups.values.size(); ++i) {
            groups.values[i] = scale * glm::vec3(static_cast<float>(i), 0.5F, 1.0F / static_cast<float>(i + 1));
        }
    };
    fill(film.groups, 0.25F);
    if (splats) {
        fill(film.splatGroups, 3.0F);
    }
    return film;
}

TEST(FilmFile, ReadsBackEveryBitOfLightGroups)
{
    const ScratchFolder folder;
    for (const bool splats : {false, true}) {
        const Film film = filmWithGroups(splats);
        writeFilm(folder / "a.exr", film);
        const Film back = readFilm(folder / "a.exr");
        EXPECT_EQ(back.groups.values, film.groups.values);
        EXPECT_EQ(back.splatGroups.values, film.splatGroups.values);
        const Image image = readExr(folder / "a.exr");
        for (std::size_t i = 0; i < film.pixels.size(); ++i) {
            EXPECT_EQ(image.channels.at("lights.others.B")[i], shownOfGroup(film, i, 1).b);
            EXPECT_EQ(image.channels.at("lightsProducts.key.others.R")[i], film.groups.of(i)[3].r);
        }
        EXPECT_EQ(image.channels.contains("cameraLights.key.R"), splats);
        Film other = film;
        other.groups.values[5].g += 1.0F;
        EXPECT_NE(computeDigest(other), computeDigest(film));
    }
}

TEST(FilmFile, CheckpointsHaveHalves)
{
    const ScratchFolder folder;
    Checkpoint checkpoint = makeCheckpoint(filmWithSplats()).value();
    static_cast<FilmMoments&>(checkpoint.halves[0]) = filmWithSplats();
    const std::vector<glm::vec3> colors(checkpoint.halves[0].pixels.size(), glm::vec3(1.0F));
    const DenoisedLayers denoised{colors, colors, "none"};
    for (const bool both : {true, false}) {
        checkpoint.halves[1] = both ? simulateFilm(64, 128) : FilmMoments();
        writeFilm(folder / "a.exr", makeFilm(checkpoint), {&checkpoint, &denoised});
        const StoredFilm stored = readStoredFilm(folder / "a.exr");
        ASSERT_TRUE(stored.checkpoint && stored.checkpoint->hasHalves());
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_TRUE(sameBits(stored.checkpoint->halves[i].pixels, checkpoint.halves[i].pixels));
        }
        EXPECT_EQ(computeHalvesDigest(*stored.checkpoint), computeHalvesDigest(checkpoint));
        EXPECT_EQ(computeDigest(*stored.checkpoint), computeDigest(checkpoint));
        EXPECT_TRUE(readDenoised(folder / "a.exr"));
    }
    for (const bool second : {false, true}) {
        const std::vector<std::uint32_t> counts(checkpoint.film.pixels.size(), second ? 3 : 4);
        checkpoint.progress.adaptive = AdaptiveProgress{64, 128, 64, 128, true, second, counts, counts, {}};
        checkpoint.progress.adaptive->blocksLater.resize(second ? 0 : counts.size(), 2);
        checkpoint.before.pixels = second ? simulateFilm(64, 128).pixels : std::vector<PixelMoments>();
        checkpoint.common = checkpoint.halves[0];
        writeFilm(folder / "a.exr", makeFilm(checkpoint), checkpoint);
        const Checkpoint back = readStoredFilm(folder / "a.exr").checkpoint.value();
        EXPECT_EQ(back.progress.adaptive->second, second);
        EXPECT_EQ(back.progress.adaptive->blocksLater, checkpoint.progress.adaptive->blocksLater);
        EXPECT_TRUE(sameBits(back.before.pixels, checkpoint.before.pixels));
        EXPECT_EQ(computeHalvesDigest(back), computeHalvesDigest(checkpoint));
        EXPECT_EQ(computeDigest(back), computeDigest(checkpoint));
    }
    checkpoint.progress.adaptive.reset();
    checkpoint.common = checkpoint.before = {};
    checkpoint.halves = {};
    writeFilm(folder / "a.exr", makeFilm(checkpoint), checkpoint);
    EXPECT_FALSE(readStoredFilm(folder / "a.exr").checkpoint->hasHalves());
}

TEST(FilmFile, CheckpointsHaveLightGroups)
{
    const ScratchFolder folder;
    Film film = filmWithGroups(true);
    Checkpoint checkpoint = makeCheckpoint(film).value();
    ASSERT_FALSE(checkpoint.page.groups.isEmpty());
    writeFilm(folder / "a.exr", makeFilm(checkpoint), checkpoint);
    checkpoint.common = film;
    checkpoint.progress.adaptive.emplace().chosen.assign(film.pixels.size(), 1);
    checkpoint.progress.adaptive->blocksLeft.assign(film.pixels.size(), 1);
    writeFilm(folder / "b.exr", makeFilm(checkpoint), checkpoint);
    for (const char* name : {"a.exr", "b.exr"}) {
        const StoredFilm stored = readStoredFilm(folder / name);
        ASSERT_TRUE(stored.checkpoint);
        EXPECT_EQ(stored.film.groups.values, film.groups.values);
        EXPECT_EQ(stored.checkpoint->page.groups.values, film.groups.values);
        EXPECT_EQ(stored.checkpoint->page.splatGroups.values, film.splatGroups.values);
        EXPECT_EQ(makeFilm(*stored.checkpoint).groups.values, film.groups.values);
    }
    EXPECT_EQ(readStoredFilm(folder / "b.exr").checkpoint->common.groups.values, film.groups.values);
}

TEST(FilmFile, PixelsDigestIgnoresKernelsAndDevice)
{
    const ScratchFolder folder;
    Film film = filmWithSplats();
    const std::string digest = computeDigest(film), pixels = computePixelsDigest(film);
    film.identity.kernels = "others";
    film.arithmetic = "another";
    EXPECT_NE(computeDigest(film), digest);
    EXPECT_EQ(computePixelsDigest(film), pixels);
    writeFilm(folder / "a.exr", film);
    EXPECT_EQ(std::get<std::string>(readExrHeader(folder / "a.exr").attributes.at("glim:pixels")), pixels);
    for (float* value : {&film.pixels[1].depth, &film.splats[1].clamped}) {
        *value += 1.0F;
        EXPECT_NE(computePixelsDigest(film), pixels);
        *value -= 1.0F;
    }
}

// Asserts (tools/test --sanitize) see whether the sum of the blocks overflows.
TEST(FilmFile, ReadsBackAnyNumberOfBlocks)
{
    Film film = filmWithSplats();
    film.pixels[0].blocks = film.splats[0].blocks = std::numeric_limits<std::uint32_t>::max();
    film.splats[1].blocks = std::numeric_limits<std::uint32_t>::max();
    const ScratchFolder folder;
    writeFilm(folder / "a.exr", film);
    EXPECT_EQ(computeDigest(readFilm(folder / "a.exr")), computeDigest(film));
}

TEST(FilmFile, AnAbandonedWriteLeavesTheFileAsItWas)
{
    const ScratchFolder folder;
    writeFilm(folder / "a.exr", simulateFilm(0, 64));
    const std::string before = readFileBytes(folder / "a.exr");
    Checkpoint checkpoint;
    checkpoint.film = simulateFilm(0, 256);
    EXPECT_FALSE(writeFilm(folder / "a.exr", checkpoint.film, checkpoint, [] { return false; }));
    EXPECT_EQ(readFileBytes(folder / "a.exr"), before);
    EXPECT_EQ(folder.entries(), 1);
    EXPECT_TRUE(writeFilm(folder / "a.exr", checkpoint.film, checkpoint));
    EXPECT_NE(readFileBytes(folder / "a.exr"), before);
}

TEST(FilmFile, ShowsCameraAndLightPathsTogether)
{
    const ScratchFolder folder;
    const Film film = filmWithSplats();
    writeFilm(folder / "a.exr", film);
    const Image image = readExr(folder / "a.exr");
    const PixelMoments& pixel = film.pixels[9];
    const SplatMoments& splat = film.splats[9];
    EXPECT_EQ(image.channels.at("G")[9], pixel.mean.g + splat.mean.g);
    EXPECT_EQ(image.channels.at("camera.G")[9], pixel.mean.g);
    const float variance = computeVarianceOfMean(pixel).g + splat.squares.g / (2.0F * 128.0F);
    EXPECT_NEAR(image.channels.at("variance.G")[9], variance, 1e-6F * variance);
    // Between the fewer blocks of the two and those of both.
    const std::uint32_t blocks = shownPixel(film, 9).blocks;
    EXPECT_GE(blocks, 3U);
    EXPECT_LE(blocks, pixel.blocks + 2);
}

TEST(FilmFile, TheSameFilmGivesTheSameBytes)
{
    const ScratchFolder folder;
    writeFilm(folder / "a.exr", simulateFilm(0, 300));
    writeFilm(folder / "b.exr", simulateFilm(0, 300));
    EXPECT_EQ(readFileBytes(folder / "a.exr"), readFileBytes(folder / "b.exr"));
}

TEST(FilmFile, HasTheLayersOtherProgramsLookFor)
{
    const ScratchFolder folder;
    const Film film = simulateFilm(0, 128);
    writeFilm(folder / "a.exr", film);
    const Image image = readExr(folder / "a.exr");
    const PixelMoments& pixel = film.pixels[9];
    EXPECT_EQ(image.channels.at("R")[9], pixel.mean.x);
    EXPECT_EQ(image.channels.at("B")[9], pixel.mean.z);
    EXPECT_EQ(image.channels.at("A")[9], pixel.alpha);
    EXPECT_EQ(image.channels.at("albedo.G")[9], pixel.albedo.y);
    EXPECT_EQ(image.channels.at("normal.Z")[9], pixel.normal.z);
    EXPECT_EQ(image.channels.at("depth.Z")[9], pixel.depth);
    EXPECT_TRUE(std::isinf(image.channels.at("depth.Z")[9]));
    EXPECT_EQ(image.counts.at("count.X")[9], 128U);
    EXPECT_EQ(std::get<std::string>(image.attributes.at("glim:samples")), "0:128");
}

// Blocks of 32, 32, 64 and 64: the variance of the mean from the blocks' distances from it.
TEST(FilmFile, VarianceIsThatOfTheMean)
{
    const ScratchFolder folder;
    writeFilm(folder / "a.exr", simulateFilm(0, 192));
    const Image image = readExr(folder / "a.exr");
    for (std::uint32_t pixel = 0; pixel < image.width * image.height; ++pixel) {
        double sum = 0, squares = 0;
        for (const auto& [begin, end] : {std::pair{0U, 32U}, {32U, 64U}, {64U, 128U}, {128U, 192U}}) {
            const double count = end - begin, mean = static_cast<double>(test::simulateBlock(1, pixel, begin, end).mean.y);
            sum += count * mean;
            squares += count * mean * mean;
        }
        const double variance = (squares - sum * sum / 192) / 3 / 192;
        EXPECT_NEAR(static_cast<double>(image.channels.at("variance.G")[pixel]), variance, 1e-5 * squares);
        EXPECT_EQ(image.channels.at("error.G")[pixel], std::sqrt(image.channels.at("variance.G")[pixel]));
    }
}

// Files are written in bands of rows.
TEST(FilmFile, EveryRowHasItsOwnVariance)
{
    const ScratchFolder folder;
    Film film = simulateFilm(0, 128);
    film.width = 1;
    film.height = 1100;
    film.pixels.resize(1100, film.pixels[0]);
    std::vector<glm::vec3> denoised, error;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        film.pixels[i].squares = glm::vec3(static_cast<float>(i + 1));
        denoised.emplace_back(static_cast<float>(i), 1.0F, 2.0F);
        error.emplace_back(3.0F, static_cast<float>(i), 4.0F);
    }
    const DenoisedLayers layers{denoised, error, "none"};
    writeFilm(folder / "a.exr", film, {.denoised = &layers});
    const Image image = readExr(folder / "a.exr");
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        ASSERT_EQ(image.channels.at("variance.G")[i], computeVarianceOfMean(film.pixels[i]).g) << i;
        ASSERT_EQ(image.channels.at("error.G")[i], std::sqrt(computeVarianceOfMean(film.pixels[i]).g)) << i;
        ASSERT_EQ(image.channels.at("denoised.R")[i], static_cast<float>(i));
        ASSERT_EQ(image.channels.at("denoisedError.G")[i], static_cast<float>(i));
    }
    EXPECT_EQ(computeDigest(readFilm(folder / "a.exr")), computeDigest(film));
}

// Rows of a crop: the data window is where they are in the picture.
TEST(FilmFile, ACropIsPartOfThePicture)
{
    const ScratchFolder folder;
    Film film = simulateFilm(0, 64);
    film.rowsAbove = 2;
    film.rowsBelow = 3;
    film.crop = Crop{{11, 20}, {film.width, film.height + 5}, {40, 60}};
    writeFilm(folder / "a.exr", film);
    const Image image = readExr(folder / "a.exr");
    EXPECT_EQ(image.columnsLeft, 11U);
    EXPECT_EQ(image.columnsLeft + image.width + image.columnsRight, 40U);
    EXPECT_EQ(image.rowsAbove, 22U);
    EXPECT_EQ(image.rowsAbove + image.height + image.rowsBelow, 60U);
    const Film back = readFilm(folder / "a.exr");
    EXPECT_EQ(back.crop, film.crop);
    EXPECT_EQ(back.rowsAbove, 2U);
    EXPECT_EQ(back.rowsBelow, 3U);
    EXPECT_TRUE(sameBits(back.pixels, film.pixels));
    const Picture picture = makePicture(back);
    EXPECT_EQ(glm::uvec2(picture.columnsLeft, picture.rowsAbove), glm::uvec2(11, 22));
}

TEST(FilmFile, UnknownVarianceIsLeftOutOrInfinite)
{
    const ScratchFolder folder;
    writeFilm(folder / "a.exr", simulateFilm(0, 32));
    EXPECT_FALSE(readExr(folder / "a.exr").channels.contains("variance.R"));
    Film film = simulateFilm(0, 64);
    film.pixels[2].blocks = 1;
    writeFilm(folder / "b.exr", film);
    const std::vector<float> variance = readExr(folder / "b.exr").channels.at("variance.R");
    for (std::size_t pixel = 0; pixel < variance.size(); ++pixel) {
        EXPECT_EQ(std::isinf(variance[pixel]), pixel == 2);
        EXPECT_FALSE(std::isnan(variance[pixel]));
    }
    // The error of the others is known; that of a picture whose square overflowed is not.
    const auto errorsOfFile = [&] {
        writeFilm(folder / "b.exr", film);
        return estimateErrors(makePicture(readExr(folder / "b.exr"), "b.exr"));
    };
    EXPECT_EQ(errorsOfFile()->mse, estimateErrors(makePicture(film))->mse);
    film.pixels[3].squares.g = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(errorsOfFile());
}

class FilmFileRefusal : public testing::Test {
protected:
    FilmFileRefusal()
    {
        writeFilm(path, simulateFilm(0, 64));
        image = readExr(path);
    }
    void expectRefused(MessageId id, test::Parts parts) const
    {
        writeExr(path, image);
        parts.file = path;
        expectRefusal<InputError>([&] { readFilm(path); }, id, parts);
    }
    const ScratchFolder folder;
    const std::filesystem::path path = folder / "a.exr";
    Image image;
};

TEST_F(FilmFileRefusal, OfAnotherPicture)
{
    image.attributes.clear();
    expectRefused(MessageId::UnknownFormat, {.place = "glim:film"});
}

TEST_F(FilmFileRefusal, OfALaterFormat)
{
    image.attributes["glim:film"] = 5.0;
    expectRefused(MessageId::UnknownFormat, {.value = "5", .expected = "1 to 4"});
}

TEST_F(FilmFileRefusal, OfALostChannel)
{
    image.channels.erase("squares.G");
    expectRefused(MessageId::FileDamaged, {.place = "squares.G"});
}

TEST_F(FilmFileRefusal, OfCountsThatAnotherProgramMadeFloats)
{
    image.counts.erase("count.X");
    image.channels["count.X"].assign(image.channels["R"].size(), 64.0F);
    expectRefused(MessageId::FileDamaged, {.place = "count.X"});
}

TEST_F(FilmFileRefusal, OfANegativeSeed)
{
    image.attributes["glim:seed"] = -1.0;
    expectRefused(MessageId::OutOfRange, {.place = "seed", .value = "-1.000000"});
}

TEST_F(FilmFileRefusal, OfImpossibleSampleRanges)
{
    for (const char* ranges : {"64:0", "0:64 32:96", "0-64", "0:64x", "0:", "-1:5", "0:4294967296", "64:128 0:64"}) {
        image.attributes["glim:samples"] = std::string(ranges);
        expectRefused(MessageId::Malformed, {.place = "sample ranges", .value = ranges});
    }
}

TEST_F(FilmFileRefusal, OfACropThatIsNotTheDataWindow)
{
    for (const char* crop : {"", "0,0,7", "1,0,7,5", "0,0,6,5", "0,0,7,4", "0,0,7,9", "0,1,7,4", "0,0,7,5x", "0, 0,7,5", "-1,0,7,5"}) {
        image.attributes["glim:crop"] = std::string(crop);
        expectRefused(MessageId::Malformed, {.place = "crop", .value = crop});
    }
    image.attributes["glim:crop"] = 4.0;
    expectRefused(MessageId::Malformed, {.place = "crop"});
}

TEST_F(FilmFileRefusal, OfACameraWithoutAPose)
{
    for (const char* camera : {"pose", R"({"pose":3})", R"({"pose":[[1,0,0,0]]})"}) {
        image.attributes["glim:camera"] = std::string(camera);
        expectRefused(MessageId::Malformed, {.place = "camera", .value = camera});
    }
}

// With a guide that knows something.
Checkpoint guidedCheckpoint()
{
    Random random(1);
    const auto guide = std::make_shared<Guide>(guideOf(recordsOfBall(20'000, random)));
    guide->paths = (1ULL << 53U) + 1;
    guide->seconds = 1.0 / 3.0;
    Checkpoint checkpoint;
    checkpoint.film = simulateFilm(0, 256);
    checkpoint.film.identity.settings = "seed=1 guide=" + guide->digest + " bounces=64";
    checkpoint.progress.sample = checkpoint.progress.lightSample = 256;
    checkpoint.guide = LearnedGuide{guide, 1e-1};
    return checkpoint;
}

TEST(FilmFile, CheckpointsKeepTheGuide)
{
    const ScratchFolder folder;
    const Checkpoint checkpoint = guidedCheckpoint();
    const Guide& guide = *checkpoint.guide->guide;
    writeFilm(folder / "a.exr", checkpoint.film, checkpoint);
    for (const auto& back : {readGuide(folder / "a.exr"), readStoredFilm(folder / "a.exr").checkpoint->guide}) {
        ASSERT_TRUE(back && back->guide);
        EXPECT_EQ(back->guide->texels, guide.texels);
        EXPECT_EQ(back->guide->digest, guide.digest);
        EXPECT_EQ(back->guide->cells, guide.cells);
        EXPECT_EQ(back->guide->paths, guide.paths);
        EXPECT_EQ(back->guide->seconds, guide.seconds);
        EXPECT_EQ(back->gain, 1e-1);
    }
    writeFilm(folder / "a.exr", checkpoint.film);
    EXPECT_FALSE(readGuide(folder / "a.exr"));
    EXPECT_FALSE(readExr(folder / "a.exr").attributes.contains("glim:guideTexels"));
}

TEST(FilmFile, CheckpointsKnowThatAGuideWouldNotPay)
{
    const ScratchFolder folder;
    Checkpoint checkpoint = guidedCheckpoint();
    checkpoint.film.identity.settings = "seed=1 bounces=64";
    for (const std::optional<double> gain : {std::optional<double>(), std::optional(0.75)}) {
        checkpoint.guide = LearnedGuide{nullptr, gain};
        writeFilm(folder / "a.exr", checkpoint.film, checkpoint);
        const auto back = readGuide(folder / "a.exr");
        ASSERT_TRUE(back);
        EXPECT_FALSE(back->guide);
        EXPECT_EQ(back->gain, gain);
    }
}

// As by someone who knows how the header is sealed.
TEST(FilmFile, RefusesDamagedGuides)
{
    const ScratchFolder folder;
    const auto path = folder / "a.exr";
    const Checkpoint checkpoint = guidedCheckpoint();
    writeFilm(path, checkpoint.film, checkpoint);
    const Image image = readExr(path);
    const auto expectDamaged = [&](const Image& damaged, MessageId id, const test::Parts& parts) {
        writeExr(path, damaged);
        expectRefusal<InputError>([&] { readGuide(path); }, id, parts);
    };
    Image damaged = image;
    auto& bytes = std::get<OpaqueBytes>(damaged.attributes.at("glim:guideTexels"));
    bytes[16 * kUniformQuadtree + 1] ^= std::byte{1};
    expectDamaged(damaged, MessageId::FileDamaged, {.place = "guide", .expected = checkpoint.guide->guide->digest});
    damaged = image;
    damaged.attributes.erase("glim:guideTexels");
    expectDamaged(damaged, MessageId::UnknownFormat, {.place = "glim:guideTexels"});
    for (const char* text : {"none", "cells=1 paths=2", "cells=1 paths=2 seconds=x", "cells=-1 paths=2 seconds=3"}) {
        damaged = image;
        damaged.attributes["glim:guide"] = text;
        expectDamaged(damaged, MessageId::FileDamaged, {.place = "guide", .value = text});
    }
    damaged = image;
    damaged.attributes["glim:settings"] = "seed=1 bounces=64";
    expectDamaged(damaged, MessageId::FileDamaged, {.place = "guide"});
}

// Its digest is right, but its first tree leads into the second one.
TEST(FilmFile, RefusesGuidesThatNoDescentEndsIn)
{
    const ScratchFolder folder;
    Checkpoint checkpoint = guidedCheckpoint();
    Guide crafted = *checkpoint.guide->guide;
    crafted.texels[0].w = crafted.texels[1].w;
    crafted.digest = digestOf(crafted.texels);
    checkpoint.film.identity.settings = "guide=" + crafted.digest;
    checkpoint.guide->guide = std::make_shared<const Guide>(crafted);
    writeFilm(folder / "a.exr", checkpoint.film, checkpoint);
    expectRefusal<InputError>([&] { readStoredFilm(folder / "a.exr"); }, MessageId::FileDamaged,
                              {.place = "guide", .value = std::to_string(crafted.texels.size()) + " texels"});
}

// Where the table of rows begins, after the empty name that ends the header.
std::size_t headerEnd(const std::string& film)
{
    std::size_t at = 8;
    while (film[at] != '\0') {
        at = film.find('\0', film.find('\0', at) + 1) + 1;
        std::uint32_t bytes = 0;
        std::memcpy(&bytes, &film[at], sizeof bytes);
        at += sizeof bytes + bytes;
    }
    return at + 1;
}

TEST(FilmFile, AnyDamageToTheHeaderIsNoticed)
{
    const ScratchFolder folder;
    const auto path = folder / "a.exr";
    Checkpoint checkpoint;
    checkpoint.film = filmWithSplats();
    checkpoint.progress.sample = checkpoint.progress.lightSample = checkpoint.film.sampleRanges[0].second;
    writeFilm(path, checkpoint.film, checkpoint);
    ASSERT_TRUE(readStoredFilm(path).checkpoint);
    const std::string whole = readFileBytes(path);
    const std::size_t end = headerEnd(whole);
    ASSERT_GT(end, 1500U);
    for (std::size_t at = 0; at < end; ++at) {
        for (const int flip : {1 << at % 8, 0xFF}) {
            std::string damaged = whole;
            damaged[at] = static_cast<char>(damaged[at] ^ flip);
            test::writeText(path, damaged);
            EXPECT_THROW(readFilmHeader(path), InputError) << "byte " << at << " of " << end << ", by " << flip;
            if (at % 16 == 0) {
                EXPECT_THROW(readStoredFilm(path), InputError) << "byte " << at << " of " << end << ", by " << flip;
            }
        }
    }
}

// By glim 0.2: the formats 1 and 2, without a seal.
TEST(FilmFile, EarlierFilmsAreRead)
{
    const ScratchFolder folder;
    const auto path = folder / "a.exr";
    for (const Film& film : {simulateFilm(0, 64), filmWithSplats()}) {
        writeFilm(path, film);
        Image image = readExr(path);
        image.attributes["glim:film"] = film.splats.empty() ? 1.0 : 2.0;
        image.attributes.erase("glim:headerDigest");
        writeExr(path, image);
        EXPECT_EQ(computeDigest(readFilm(path)), computeDigest(film));
        image.attributes["glim:film"] = film.splats.empty() ? 3.0 : 4.0;
        writeExr(path, image);
        expectRefusal<InputError>([&] { readFilm(path); }, MessageId::FileDamaged, {.file = path, .place = "glim:headerDigest"});
    }
}

}  // namespace
}  // namespace glim
