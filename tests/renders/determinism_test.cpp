// The same seed gives the same bits, however the work is cut and whatever else is compiled in.
#include "host/render/film_file.hpp"
#include "host/render/merge_films.hpp"
#include "host/scene/load_gltf.hpp"
#include "places.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/named.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <map>

namespace glim {
namespace {

RenderSettings settingsFor(const test::Named<Sampler>& sampler)
{
    RenderSettings settings = squareSettings(40, 80);  // two whole blocks and a half
    settings.sampler = sampler.value;
    return settings;
}

class DeterminismTest : public testing::TestWithParam<test::Named<Sampler>> {
protected:
    DeterminismTest()
        : flat(flattened(scene))
    {}

    // The render that the others are compared with, made once for each sampler.
    const Film& first() const
    {
        static std::map<Sampler, Film> films;
        const auto found = films.find(GetParam().value);
        return found != films.end() ? found->second : films.emplace(GetParam().value, render(settingsFor(GetParam()))).first->second;
    }
    Film render(const RenderSettings& settings) const { return renderFlat(flat, scene.cameras.front(), settings); }

    const Scene scene = mixedScene();
    FlatScene flat;
};

TEST_P(DeterminismTest, H34TwoRuns) { EXPECT_TRUE(sameBits(first(), render(settingsFor(GetParam())))); }

TEST_P(DeterminismTest, AnotherSeedDiffers)
{
    RenderSettings settings = settingsFor(GetParam());
    settings.seed = 1;
    EXPECT_FALSE(sameBits(first(), render(settings)));
}

TEST_P(DeterminismTest, H34WorkgroupSizes)
{
    for (const std::uint32_t workgroup : {32U, 128U}) {
        RenderSettings settings = settingsFor(GetParam());
        settings.workgroup = workgroup;
        EXPECT_TRUE(sameBits(first(), render(settings))) << workgroup;
    }
}

TEST_P(DeterminismTest, H34DispatchSizes)
{
    for (const std::uint32_t capacity : {1U << 8, 3000U, 1U << 16}) {
        RenderSettings settings = settingsFor(GetParam());
        settings.pathCapacity = capacity;
        EXPECT_TRUE(sameBits(first(), render(settings))) << capacity;
    }
}

TEST_P(DeterminismTest, FeaturesThatTheSceneDoesNotNeed)
{
    SceneBuilder builder;
    builder.cube(1.0F, builder.lambert(glm::vec3(0.6F), glm::vec3(0.3F)), true).perspective({0, 0, 0.5F}, {0, 0, 0}, 1.0F);
    FlatScene lean = flattened(builder.scene());
    const Film bare = renderFlat(lean, builder.scene().cameras.front(), settingsFor(GetParam()));
    // Without smooth normals and an environment, which would need data. The other features are compiled in and never used.
    lean.features |= kFeatureSpheres | kFeatureMirror | kFeatureDielectric | kFeatureSphereLights | kFeaturePunctualLights;
    EXPECT_TRUE(sameBits(bare, renderFlat(lean, builder.scene().cameras.front(), settingsFor(GetParam()))));
}

INSTANTIATE_TEST_SUITE_P(Samplers, DeterminismTest,
                         testing::Values(test::Named{"sobol", Sampler::Sobol}, test::Named{"independent", Sampler::Independent}),
                         test::nameOfParameter);

TEST(MergedRenderTest, H34PagesMergeToTheBitsOfTheSingleRun)
{
    const test::ScratchFolder folder;
    const Scene scene = mixedScene();
    RenderSettings settings = squareSettings(16, 512);
    writeFilm(folder / "whole.exr", renderScene(scene, settings));
    settings.sampleEnd = 256;
    writeFilm(folder / "a.exr", renderScene(scene, settings));
    settings.sampleBegin = 256;
    settings.sampleEnd = 512;
    writeFilm(folder / "b.exr", renderScene(scene, settings));
    const MergedFilm merged = mergeFilms({folder / "a.exr", folder / "b.exr"});
    EXPECT_TRUE(merged.exact);
    EXPECT_TRUE(sameBits(merged.film, readFilm(folder / "whole.exr")));
}

// FNV-1a of all moments.
std::uint64_t computeHash(const Film& film)
{
    std::uint64_t hash = 14695981039346656037ULL;
    const auto add = [&hash](std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes) {
            hash = (hash ^ static_cast<std::uint64_t>(byte)) * 1099511628211ULL;
        }
    };
    add(std::as_bytes(std::span<const PixelMoments>(film.pixels)));
    add(std::as_bytes(std::span<const SplatMoments>(film.splats)));
    return hash;
}

// These renders run every path of a kernel. Their hashes change when the picture is meant to change, and must be the same on every device
// that rounds to nearest: tools/test --driver checks that.
void expectHash(const std::string& name, const Film& film, std::uint64_t expected)
{
    const std::uint64_t hash = computeHash(film);
    std::printf("%s on %s: %#018llx\n", name.c_str(), film.device.c_str(), static_cast<unsigned long long>(hash));
    EXPECT_EQ(hash, expected);
}

TEST(DriverAgreementTest, H34TheSameBitsOnEveryDevice)
{
    expectHash("mixed scene", renderScene(mixedScene(), squareSettings(64, 64)), 0x38df4a461c993c68ULL);
}

TEST(DriverAgreementTest, H34EveryMaterialTheSameBits)
{
    RenderSettings settings = squareSettings(48, 64);
    settings.schedule = Schedule::Auto;  // GoldenTest compares the two
    expectHash("materials", renderScene(loadGltf(GLIM_SOURCE_DIR "/scenes/materials.gltf"), settings), 0x61140e3052a1c84eULL);
}

}  // namespace
}  // namespace glim
