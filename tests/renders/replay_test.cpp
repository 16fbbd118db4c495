// A path that is traced again, alone, has the bits that it had in the picture. The contributions that are printed add up to them.
#include "host/render/replay.hpp"
#include "host/bvh/build_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/suspects.hpp"
#include "host/scene/load_gltf.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/single_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <numeric>

namespace glim {
namespace {

constexpr std::uint32_t kSide = 16, kSeed = 5;

RenderSettings smallSettings(std::uint32_t begin, std::uint32_t end)
{
    RenderSettings settings = squareSettings(kSide, end);
    settings.sampleBegin = begin;
    settings.seed = kSeed;
    return settings;
}

bool sameBits(const vec3& a, const vec3& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

double computeLuminance(const vec3& color) { return glm::dot(glm::dvec3(color), glm::dvec3(0.2126, 0.7152, 0.0722)); }

// Everything that was added, in order and in float32.
PathRadiance sumOf(const ReplayedPath& path)
{
    PathRadiance sum{};
    const auto add = [&](const PathRadiance& added) {
        sum.radiance += added.radiance;
        sum.clamped += added.clamped;
    };
    for (const PathVertex& vertex : path.vertices) {
        add(vertex.emitted);
        for (const SampledLight& each : vertex.sampledLights) {
            add(each.added);
        }
    }
    return sum;
}

// Each vertex leaves where the next one arrives.
void expectConnected(const FlatScene& flat, const ReplayedPath& path)
{
    ASSERT_FALSE(path.vertices.empty());
    for (std::size_t i = 0; i < path.vertices.size(); ++i) {
        const PathVertex& vertex = path.vertices[i];
        EXPECT_EQ(vertex.bounce, i);
        ASSERT_EQ(vertex.end == PathEnd::Continues, i + 1 < path.vertices.size());
        if (vertex.end == PathEnd::Continues && flat.scattering.empty()) {  // else a walk may lie between the two
            const PathVertex& next = path.vertices[i + 1];
            EXPECT_EQ(next.before.throughput, vertex.after.throughput);
            EXPECT_EQ(next.before.pdf, vertex.after.pdf);
            EXPECT_EQ(next.ray.source, flat.primitiveRefs[std::size_t{vertex.hit.primitiveRef} * kPrimitiveRefTexels].w);
            EXPECT_EQ(vertex.after.throughput, vertex.bsdf.throughput * (1.0F / vertex.bsdf.continuation));
        }
    }
}

class ReplayTest : public ::testing::Test {
protected:
    void load(const std::string& name)
    {
        scene_ = loadGltf(test::sceneFile(name), {});
        flat_ = flattened(scene_);
        camera_ = flattenCamera(scene_.cameras.front(), 1.0F);
    }
    Film render(const RenderSettings& settings) { return renderFlat(flat_, scene_.cameras.front(), settings); }

    // The brightest `count` pixels of a picture of sample `sample` alone, and every 17th.
    void expectReplays(const RenderSettings& settings, std::size_t count)
    {
        const Film film = render(settings);
        std::vector<std::uint32_t> order(film.pixels.size());
        std::iota(order.begin(), order.end(), 0U);
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return computeLuminance(film.pixels[a].mean) > computeLuminance(film.pixels[b].mean);
        });
        order.resize(count);
        for (std::uint32_t pixel = 0; pixel < film.pixels.size(); pixel += 17) {
            order.push_back(pixel);
        }
        Replay replay(testDevice(), flat_, camera_, settings);
        for (const std::uint32_t pixel : order) {
            SCOPED_TRACE("pixel " + std::to_string(pixel));
            const ReplayedPath path = replay.trace(pixel, settings.sampleBegin);
            EXPECT_TRUE(sameBits(path.radiance.radiance, film.pixels[pixel].mean));
            EXPECT_EQ(path.radiance.clamped, film.pixels[pixel].clamped);
            const PathRadiance sum = sumOf(path);
            EXPECT_TRUE(sameBits(sum.radiance, path.radiance.radiance));
            EXPECT_EQ(sum.clamped, path.radiance.clamped);
            expectConnected(flat_, path);
            vertices_ += path.vertices.size();
        }
        EXPECT_GT(computeLuminance(film.pixels[order[0]].mean), 0.0);
    }

    Scene scene_;
    FlatScene flat_;
    FlatCamera camera_{};
    std::size_t vertices_ = 0;
};

TEST_F(ReplayTest, HasTheBitsOfTheSampleInEveryScene)
{
    for (const auto& [name, sample] : {std::pair("cornell_mirror_glass.gltf", 1003U),
                                       {"cornell_gems.gltf", 40U},
                                       {"many_lights.gltf", 0U},
                                       {"veach_mis.gltf", 7U},
                                       {"light_spot.gltf", 2U}}) {
        SCOPED_TRACE(name);
        load(name);
        expectReplays(smallSettings(sample, sample + 1), 12);
    }
    EXPECT_GT(vertices_, 250U);
}

TEST_F(ReplayTest, HasThemOfWalksThroughVolumes)
{
    load("wax.gltf");
    expectReplays(smallSettings(3, 4), 12);
    Replay replay(testDevice(), flat_, camera_, smallSettings(0, 64));
    float scatterings = 0.0F;
    std::size_t within = 0;
    for (std::uint32_t pixel = 0; pixel < kSide * kSide; pixel += 5) {
        for (const PathVertex& vertex : replay.trace(pixel, 0).vertices) {
            scatterings = std::max(scatterings, -vertex.before.cosine);
            within += vertex.end == PathEnd::WithinVolume ? 1 : 0;
        }
    }
    EXPECT_GT(scatterings, 10.0F);
    EXPECT_GT(within, 0U);
}

TEST_F(ReplayTest, HasThemHoweverLightIsFound)
{
    load("cornell_mirror_glass.gltf");
    for (const DirectLight direct : {DirectLight::Lights, DirectLight::Hemisphere, DirectLight::Bsdf}) {
        SCOPED_TRACE(static_cast<int>(direct));
        RenderSettings settings = smallSettings(3, 4);
        settings.course.direct = direct;
        settings.course.lightSamples = direct == DirectLight::Bsdf ? 1 : 3;
        expectReplays(settings, 4);
    }
    RenderSettings settings = smallSettings(40, 41);
    settings.course.accelerator = Accelerator::None;
    settings.course.roulette = Roulette::Fixed;
    settings.sampler = Sampler::Independent;
    settings.clampIndirect = 0.1F;
    expectReplays(settings, 4);
    settings.paths = PathParts::Indirect;
    settings.bounces = 3;
    expectReplays(settings, 4);
}

struct Tally {
    int emitted = 0, shadowed = 0, lit = 0;
    std::map<PathEnd, int> ends;
};

double power(float f, float g)
{
    const double a = static_cast<double>(f), b = static_cast<double>(g);
    return a * a / (a * a + b * b);
}

// By the vertex's own numbers: MIS weights are those of the power heuristic, the point is on the ray, and light counts as it came.
void checkVertex(const PathVertex& vertex, std::size_t lights, Tally& tally)
{
    ++tally.ends[vertex.end];
    if (vertex.surface.lightPdfOfHit > 0.0F) {
        EXPECT_NEAR(static_cast<double>(vertex.surface.misWeightOfHit), power(vertex.before.pdf, vertex.surface.lightPdfOfHit), 1e-6);
        ++tally.emitted;
    }
    if (vertex.hit.primitiveRef != kNoPrimitiveRef) {
        const vec3 there = vertex.ray.origin + vertex.hit.t * vertex.ray.direction;
        EXPECT_LT(glm::distance(vertex.surface.point, there), 1e-5F * (1.0F + glm::length(there) + vertex.hit.t));
        EXPECT_NEAR(glm::length(vertex.surface.ng), 1.0F, 1e-6F);
        EXPECT_LE(glm::dot(vertex.surface.ng, vertex.ray.direction), 0.0F);
    }
    for (const SampledLight& each : vertex.sampledLights) {
        if (each.hasShadowRay) {
            ASSERT_LT(each.note.light, lights);
            EXPECT_NEAR(static_cast<double>(each.note.misWeightOfLight), power(each.note.lightPdf, each.note.bsdfPdf), 1e-6);
            const bool shadowed = each.added.radiance == vec3(0.0F);
            EXPECT_TRUE(shadowed || each.added.radiance == each.ray.contribution);
            ++(shadowed ? tally.shadowed : tally.lit);
        }
    }
}

TEST_F(ReplayTest, SaysWhatTheEstimatorIsMadeOf)
{
    Tally tally;
    for (const std::string name : {"cornell.gltf", "furnace.gltf"}) {
        load(name);
        Replay replay(testDevice(), flat_, camera_, smallSettings(0, 1));
        for (std::uint32_t pixel = 0; pixel < kSide * kSide; pixel += 3) {
            for (const PathVertex& vertex : replay.trace(pixel, 0).vertices) {
                checkVertex(vertex, flat_.lights.size(), tally);
            }
        }
    }
    std::printf("%d lights hit, %d sampled and unoccluded, %d occluded\n", tally.emitted, tally.lit, tally.shadowed);
    EXPECT_GT(tally.emitted, 50);
    EXPECT_GT(tally.lit, 50);
    EXPECT_GT(tally.shadowed, 5);
    EXPECT_GT(tally.ends[PathEnd::Missed], 5);
    EXPECT_GT(tally.ends[PathEnd::Roulette], 5);
}

struct Best {
    vec3 radiance{0.0F};
    std::uint32_t pixel = 0, sample = 0;
};

// The first brightest sample of each pixel of `film`, by films of single samples; the brightest first.
std::vector<Best> findBest(const Film& film, const std::vector<Film>& singles)
{
    std::vector<Best> best(film.pixels.size());
    for (std::uint32_t i = 0; i < best.size(); ++i) {
        best[i].pixel = i;
        for (std::uint32_t sample = 0; sample < film.pixels[i].count; ++sample) {
            const vec3 radiance = singles[sample].pixels[i].mean;
            if (computeLuminance(radiance) > computeLuminance(best[i].radiance)) {
                best[i].radiance = radiance;
                best[i].sample = sample;
            }
        }
    }
    std::stable_sort(best.begin(), best.end(),
                     [](const Best& a, const Best& b) { return computeLuminance(a.radiance) > computeLuminance(b.radiance); });
    return best;
}

void expectSuspects(const std::vector<Suspect>& suspects, const std::vector<Best>& best, const Film& film)
{
    double picture = 0.0;
    for (const PixelMoments& pixel : shownPixels(film)) {
        picture += computeLuminance(pixel.mean);
    }
    ASSERT_EQ(suspects.size(), 30U);
    for (std::size_t i = 0; i < suspects.size(); ++i) {
        SCOPED_TRACE(i);
        const PixelMoments pixel = shownPixel(film, suspects[i].pixel);
        EXPECT_EQ(suspects[i].pixel, best[i].pixel);
        EXPECT_EQ(suspects[i].sampleIndex, best[i].sample);
        EXPECT_TRUE(sameBits(suspects[i].radiance, best[i].radiance));
        EXPECT_DOUBLE_EQ(suspects[i].luminance, computeLuminance(best[i].radiance));
        EXPECT_DOUBLE_EQ(suspects[i].shareOfPixel, suspects[i].luminance / (pixel.count * computeLuminance(pixel.mean)));
        EXPECT_DOUBLE_EQ(suspects[i].shareOfPicture, suspects[i].luminance / pixel.count / picture);
    }
}

TEST_F(ReplayTest, SuspectsAreTheBrightestSamples)
{
    constexpr std::uint32_t kSamples = 12;
    load("cornell_mirror_glass.gltf");
    for (const Adaptive adaptive : {Adaptive::Off, Adaptive::Course}) {
        RenderSettings settings = smallSettings(0, kSamples);
        settings.sampler = Sampler::Independent;
        settings.caustics = adaptive == Adaptive::Off;  // the course has none
        const std::vector<Film> singles = renderSingleSamples(scene_, settings);
        settings.caustics = true;
        settings.suspects = 30;
        settings.adaptive = adaptive;
        settings.course.tolerance = 0.5F;
        settings.course.batch = 4;
        Renderer renderer(testDevice(), flat_, camera_, settings);
        const Film film = renderer.render([](const RenderProgress&) { return true; });
        expectSuspects(findSuspects(renderer, film), findBest(film, singles), film);
    }
}

TEST_F(ReplayTest, BlackPixelsAreNoSuspects)
{
    load("light_spot.gltf");
    RenderSettings settings = smallSettings(0, 2);
    settings.bounces = 1;
    const Film plain = render(settings);
    settings.suspects = 1000;
    Renderer renderer(testDevice(), flat_, camera_, settings);
    const Film film = renderer.render([](const RenderProgress&) { return true; });
    EXPECT_TRUE(sameBits(plain, film));
    const auto bright = std::count_if(film.pixels.begin(), film.pixels.end(), [](const PixelMoments& p) { return p.mean != vec3(0.0F); });
    EXPECT_LT(bright, kSide * kSide);
    EXPECT_EQ(findSuspects(renderer, film).size(), static_cast<std::size_t>(bright));
}

}  // namespace
}  // namespace glim
