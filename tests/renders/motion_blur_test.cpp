// Motion blur against answers known on paper, and against means of many pictures that are sharp. renderScene demands the same bits of both
// schedules.
#include "host/flatten/flatten_scene.hpp"
#include "host/flatten/start_media.hpp"
#include "host/measure/confidence.hpp"
#include "host/measure/error_estimate.hpp"
#include "host/measure/z_test.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>

namespace glim {
namespace {

using glm::dmat4;
using glm::dvec3;

constexpr std::uint32_t kSide = 32;

dmat4 shift(const dvec3& by) { return glm::translate(dmat4(1.0), by); }
dmat4 turn(double angle, const dvec3& axis) { return glm::rotate(dmat4(1.0), angle, glm::normalize(axis)); }

// Evenly from one place to the next.
std::shared_ptr<const Motion> motionBy(const std::vector<dmat4>& places)
{
    Motion motion;
    for (std::size_t i = 0; i < places.size(); ++i) {
        MotionKey key = splitTransform(places[i]);
        key.time = static_cast<double>(i) / static_cast<double>(places.size() - 1);
        key.rotation = i > 0 && glm::dot(motion.back().rotation, key.rotation) < 0.0 ? -key.rotation : key.rotation;
        motion.push_back(key);
    }
    return std::make_shared<const Motion>(motion);
}

// The scene as it is at one time, without motions.
Scene sharpAt(Scene scene, double time)
{
    for (MeshInstance& instance : scene.instances) {
        instance.worldFromMesh = instance.motion ? transformAt(*instance.motion, time) : instance.worldFromMesh;
        instance.motion = nullptr;
    }
    Camera& camera = scene.cameras.front();
    if (camera.motion) {
        const dmat4 moved = transformAt(*camera.motion, time);
        const glm::dmat3 turned(moved);
        camera.position = glm::vec3(dvec3(moved[3]) - scene.origin);
        camera.right = glm::vec3(turned * dvec3(camera.right));
        camera.up = glm::vec3(turned * dvec3(camera.up));
        camera.forward = glm::vec3(turned * dvec3(camera.forward));
        camera.motion = nullptr;
    }
    return scene;
}

// The mean of sharp pictures, two at random times of each of `strata` parts of the shutter: their differences give its variance. All pixels
// of a picture have the same time, but the strata are too short for that to count.
Picture meanOfSharp(const Scene& scene, RenderSettings settings, std::uint32_t strata)
{
    Random random(11);
    std::optional<Renderer> renderer;
    const auto render = [&](std::uint32_t stratum) {
        const Scene sharp = sharpAt(scene, (stratum + random.uniform()) / strata);
        const FlatScene flat = flattened(sharp);
        const FlatCamera camera = placeInMedia(flattenCamera(sharp.cameras.front(), 1.0F), flat);
        ++settings.seed;
        if (renderer) {
            renderer->setSampling(settings);
            renderer->restart(flat, camera, settings.width, settings.height);
        } else {
            renderer.emplace(testDevice(), flat, camera, settings);
        }
        return renderer->render([](const RenderProgress&) { return true; });
    };
    const std::size_t pixels = std::size_t{settings.width} * settings.height;
    std::vector<dvec3> sums(pixels, dvec3(0.0)), squares(sums);
    for (std::uint32_t stratum = 0; stratum < strata; ++stratum) {
        const Film a = render(stratum), b = render(stratum);
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
            const dvec3 first = shownPixel(a, pixel).mean, second = shownPixel(b, pixel).mean;
            sums[pixel] += 0.5 * (first + second);
            squares[pixel] += 0.25 * (first - second) * (first - second);
        }
    }
    Picture mean{settings.width, settings.height, {}, {}};
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        mean.radiance.emplace_back(sums[pixel] / static_cast<double>(strata));
        mean.variance.emplace_back(squares[pixel] / static_cast<double>(strata) / static_cast<double>(strata));
    }
    return mean;
}

void expectAgree(const char* what, const Picture& picture, const Picture& reference)
{
    constexpr double kLevel = 1e-4;
    const ZTest test = zTest(picture, reference, kLevel);
    std::printf("%s: z of the means %.2f %.2f %.2f (%.2f), worst of a block %.2f (%.2f), a bias of %.2f %% would be found\n", what,
                test.meanZ[0], test.meanZ[1], test.meanZ[2], test.meanLimit, test.worstZ, test.blockLimit, 100.0 * test.detectableBias);
    EXPECT_TRUE(test.meansAgree()) << what;
    EXPECT_TRUE(test.blocksAgree()) << what << ": " << test.worstX << ", " << test.worstY;
    EXPECT_TRUE(test.spreadAgrees()) << what;
}

// Before black: an even background has no noise but the rounding of its sums, which no test is made for.
void expectLikeSharpOnes(const char* what, Scene scene, std::uint32_t spp = 512, std::uint32_t strata = 200)
{
    scene.environment->background = false;
    const Film film = renderScene(scene, squareSettings(kSide, samplesFor(spp)));
    expectAgree(what, makePicture(film), meanOfSharp(scene, squareSettings(kSide, 8), strata));
}

// A shape of albedo .5 in an even light that the camera does not see: each pixel shows .5 times the share of it that is covered.
Scene shapeInLight(const std::vector<glm::vec3>& corners, const std::vector<dmat4>& places)
{
    SceneBuilder builder;
    builder.polygon(corners, builder.lambert(glm::vec3(0.5F))).environment(glm::vec3(1.0F)).orthographic({0, 0, 3}, {0, 0, 0}, 1.0F);
    Scene scene = builder.scene();
    scene.environment->background = false;
    scene.instances[0].motion = motionBy(places);
    return scene;
}

const std::vector<glm::vec3> kSquare{{-0.3F, -0.3F, 0}, {0.3F, -0.3F, 0}, {0.3F, 0.3F, 0}, {-0.3F, 0.3F, 0}};

// Of a square of side .6 that goes from one place to the other, by the middles of many moments.
Picture coverageOfSquare(const dvec3& from, const dvec3& to)
{
    constexpr int kMoments = 20000;
    Picture picture{kSide, kSide, std::vector<glm::vec3>(kSide * kSide), std::vector<glm::vec3>(kSide * kSide, glm::vec3(0.0F))};
    std::vector<double> sums(kSide * kSide, 0.0);
    const double pixel = 2.0 / kSide;
    const auto covered = [pixel](std::uint32_t index, double middle, double sign) {
        const double low = sign * (-1.0 + index * pixel), high = sign * (-1.0 + (index + 1) * pixel);
        return std::max(0.0, std::min(std::max(low, high), middle + 0.3) - std::max(std::min(low, high), middle - 0.3)) / pixel;
    };
    for (int i = 0; i < kMoments; ++i) {
        const dvec3 at = glm::mix(from, to, (i + 0.5) / kMoments);
        for (std::uint32_t y = 0; y < kSide; ++y) {
            const double across = covered(y, at.y, -1.0);
            for (std::uint32_t x = 0; across > 0.0 && x < kSide; ++x) {
                sums[std::size_t{y} * kSide + x] += across * covered(x, at.x, 1.0) / kMoments;
            }
        }
    }
    std::ranges::transform(sums, picture.radiance.begin(), [](double sum) { return glm::vec3(dvec3(0.5 * sum)); });
    return picture;
}

TEST(MotionBlurTest, AMovingSquareCoversWhatItShould)
{
    const dvec3 from(-0.61, -0.2, 0.0), to(0.37, 0.31, 0.0);
    const Film film = renderScene(shapeInLight(kSquare, {shift(from), shift(to)}), squareSettings(kSide, samplesFor(1024)));
    expectAgree("a moving square", makePicture(film), coverageOfSquare(from, to));
}

// A sixth of a disc that turns around once is a sixth as bright as the disc, everywhere.
TEST(MotionBlurTest, ASpinningDiscIsEven)
{
    constexpr double kRadius = 0.9, kThird = 2.0 * std::numbers::pi / 3.0;
    std::vector<glm::vec3> wedge{{0, 0, 0}};
    for (int i = 0; i <= 8; ++i) {
        const double angle = std::numbers::pi / 24.0 * i;
        wedge.emplace_back(kRadius * std::cos(angle), kRadius * std::sin(angle), 0.0);
    }
    const dvec3 axis(0, 0, 1);
    const Scene scene = shapeInLight(wedge, {dmat4(1.0), turn(kThird, axis), turn(2.0 * kThird, axis), dmat4(1.0)});
    const Picture picture = makePicture(renderScene(scene, squareSettings(kSide, samplesFor(1024))));
    Picture disc = picture;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
        const double x = std::abs(2.0 * (i % kSide + 0.5) / kSide - 1.0), y = std::abs(2.0 * (i / kSide + 0.5) / kSide - 1.0);
        const bool isWithin = std::hypot(x + 1.0 / kSide, y + 1.0 / kSide) < kRadius * std::cos(std::numbers::pi / 48.0);
        const bool isBeyond = std::hypot(x - 1.0 / kSide, y - 1.0 / kSide) > kRadius;
        disc.radiance[i] = glm::vec3(isWithin ? 0.5F / 6.0F : isBeyond ? 0.0F : std::nanf(""));
        disc.variance[i] = glm::vec3(0.0F);
    }
    expectAgree("a spinning disc", picture, disc);
}

// A floor with quads of several colours, and a ball.
SceneBuilder yard()
{
    SceneBuilder builder;
    const auto grey = builder.lambert(glm::vec3(0.5F)), red = builder.lambert({0.8F, 0.2F, 0.1F}),
               blue = builder.lambert({0.1F, 0.2F, 0.7F});
    builder.quad({glm::vec3(-3, 0, 3), {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}}, grey)
        .quad({glm::vec3(-1.5F, 0.01F, 1), {-0.5F, 0.01F, 1}, {-0.5F, 0.01F, -1}, {-1.5F, 0.01F, -1}}, red)
        .quad({glm::vec3(0.5F, 0.01F, 1.5F), {1.5F, 0.01F, 1.5F}, {1.5F, 0.01F, 0}, {0.5F, 0.01F, 0}}, blue)
        .sphere({0, 0.5F, -0.5F}, 0.5F, red)
        .environment(glm::vec3(0.3F, 0.4F, 0.5F))
        .perspective({0, 2, 4}, {0, 0.3F, 0}, 0.7F);
    return builder;
}

void addLamp(SceneBuilder& builder)
{
    builder.quad({glm::vec3(-0.4F, 3, -0.4F), {0.4F, 3, -0.4F}, {0.4F, 3, 0.4F}, {-0.4F, 3, 0.4F}},
                 builder.lambert(glm::vec3(0.0F), glm::vec3(12.0F)));
}

// In the world, from the camera's place.
std::shared_ptr<const Motion> cameraMotion(const Camera& camera, const dvec3& by, double angle)
{
    return motionBy({shift(dvec3(camera.position)), shift(dvec3(camera.position) + by) * turn(angle, {0.2, 1.0, 0.1})});
}

TEST(MotionBlurTest, OfACameraIsTheMeanOfSharpPictures)
{
    Scene scene = yard().scene();
    scene.cameras[0].motion = cameraMotion(scene.cameras[0], {0.5, 0.2, -0.4}, 0.15);
    expectLikeSharpOnes("a moving camera", scene);
}

// A turning box and its shadow, a card with holes, and a mirrored instance with smooth normals.
TEST(MotionBlurTest, OfNodesIsTheMeanOfSharpPictures)
{
    SceneBuilder builder = yard();
    addLamp(builder);
    Material card = makeLambert({0.2F, 0.6F, 0.2F});
    card.alphaMode = AlphaMode::Blend;
    card.alpha = 0.5F;
    card.doubleSided = true;
    const auto cards = builder.add(card), white = builder.lambert(glm::vec3(0.7F));
    builder.cube(0.3F, white, false);
    Scene scene = builder.scene();
    scene.instances.back().motion = motionBy({shift({-0.8, 0.9, 0.6}), shift({0.5, 1.1, 0.4}) * turn(1.0, {1, 1, 0})});
    addMesh(scene, {{{{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0, 0.5, 0}}}}, cards);
    scene.instances.back().motion = motionBy({shift({0.8, 1.2, 0.9}), shift({1.1, 0.9, 0.9}) * turn(1.5, {0, 1, 0})});
    const Triangles ball = icosphere(2);
    addMesh(scene, ball, white, listVertices(ball));
    const dmat4 mirrored = glm::scale(dmat4(1.0), {-0.3, 0.4, 0.2});
    scene.instances.back().motion =
        motionBy({shift({-1.0, 0.6, 1.5}) * mirrored, shift({-0.4, 0.6, 1.5}) * turn(2.0, {1, 0, 1}) * mirrored});
    for (MeshInstance& instance : scene.instances) {
        instance.worldFromMesh = instance.motion ? transformAt(*instance.motion, 0.5) : instance.worldFromMesh;
    }
    scene.cameras[0].motion = cameraMotion(scene.cameras[0], {-0.2, 0.0, 0.1}, 0.05);
    expectLikeSharpOnes("nodes and a camera that move", scene);
}

// Light paths have times too. Their flashes are rare: more samples.
TEST(MotionBlurTest, OfCausticsIsTheMeanOfSharpPictures)
{
    SceneBuilder builder = yard();
    builder.quad({glm::vec3(-0.2F, 3, -0.2F), {0.2F, 3, -0.2F}, {0.2F, 3, 0.2F}, {-0.2F, 3, 0.2F}},
                 builder.lambert(glm::vec3(0.0F), glm::vec3(40.0F)));
    const auto glass = builder.glass(1.5F);
    Scene scene = builder.scene();
    const Triangles ball = icosphere(3);
    addMesh(scene, ball, glass, listVertices(ball));
    const dmat4 small = glm::scale(dmat4(1.0), dvec3(0.4));
    scene.instances.back().motion = motionBy({shift({0.2, 0.9, 0.8}) * small, shift({-0.6, 0.7, 1.0}) * small});
    scene.instances.back().worldFromMesh = shift({0.0, 0.8, 0.9}) * small;
    ASSERT_NE(flattened(scene).features & kFeatureCaustics, 0U);
    scene.cameras[0].motion = cameraMotion(scene.cameras[0], {0.3, 0.0, 0.0}, -0.05);
    expectLikeSharpOnes("a moving caustic", scene, 512, 200);
}

// The camera flies into a solid that absorbs, while that comes towards it.
TEST(MotionBlurTest, FindsTheMediaOfEachTime)
{
    SceneBuilder builder = yard();
    Material solid;
    solid.metallic = solid.roughness = 0.0F;
    solid.transmission = 1.0F;
    solid.solid = true;
    solid.absorption = {0.2F, 1.5F, 1.5F};
    builder.cube(0.5F, builder.add(solid), false);
    Scene scene = builder.scene();
    scene.instances.back().motion = motionBy({shift({0, 1.2, 2.2}), shift({0, 1.5, 3.0})});
    scene.cameras[0].motion = cameraMotion(scene.cameras[0], {0.0, -0.4, -1.2}, 0.0);
    expectLikeSharpOnes("a camera that enters a solid", scene);
}

// The variance that a film states is that of films with other seeds, and the interval of its error holds the error.
TEST(MotionBlurTest, StatesItsError)
{
    constexpr std::uint32_t kFilms = 60;
    const dvec3 from(-0.61, -0.2, 0.0), to(0.37, 0.31, 0.0);
    const Scene scene = shapeInLight(kSquare, {shift(from), shift(to)});
    const Picture truth = coverageOfSquare(from, to);
    double stated = 0.0, measured = 0.0;
    std::uint32_t held = 0;
    for (const Film& film : renderSeeds(scene, squareSettings(kSide, 128), kFilms)) {
        double error = 0.0;
        for (std::size_t i = 0; i < truth.radiance.size(); ++i) {
            const dvec3 off = dvec3(shownPixel(film, i).mean) - dvec3(truth.radiance[i]);
            error += glm::dot(off, off) / (3.0 * static_cast<double>(truth.radiance.size()));
        }
        const auto estimate = estimateError(film);
        ASSERT_TRUE(estimate);
        held += estimate->mse.low <= error && error <= estimate->mse.high ? 1 : 0;
        stated += estimate->mse.value;
        measured += error;
    }
    std::printf("stated over measured error %.3f, %u of %u intervals hold the error\n", stated / measured, held, kFilms);
    EXPECT_NEAR(stated / measured, 1.0, 0.1);
    EXPECT_GE(held, 51U) << "fewer happen with a probability of 7e-4 where 95 % hold";
}

// Times are stratified within a block of samples.
TEST(MotionBlurTest, StratifiesTimes)
{
    const Scene scene = shapeInLight(kSquare, {shift({-0.6, 0, 0}), shift({0.6, 0, 0})});
    RenderSettings settings = squareSettings(kSide, 256);
    const auto errorOf = [&] { return estimateError(renderScene(scene, settings))->mse.value; };
    const double sobol = errorOf();
    settings.sampler = Sampler::Independent;
    const double independent = errorOf();
    std::printf("MSE %.2e with Sobol' points, %.2e with independent ones\n", sobol, independent);
    EXPECT_LT(sobol, independent / 5.0);
}

// What does not move has the bits of a scene in which nothing does.
TEST(MotionBlurTest, OfNothingIsNoFeature)
{
    const Scene still = yard().scene();
    EXPECT_EQ(flattened(still).features & (kFeatureMotion | kFeatureInstances), 0U);
    Scene turning = still;
    turning.cameras[0].motion = cameraMotion(turning.cameras[0], {0.5, 0.2, -0.4}, 0.15);
    EXPECT_EQ(flattened(turning).features & (kFeatureMotion | kFeatureInstances), 0U) << "of a camera alone";
    EXPECT_TRUE(sameBits(renderScene(still, squareSettings(kSide, 32)), renderScene(sharpAt(still, 0.3), squareSettings(kSide, 32))));
}

}  // namespace
}  // namespace glim
