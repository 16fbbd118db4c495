// What films say of their cameras projects places to the pixels that show them.
#include "host/render/film_camera.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/json.hpp"
#include "host/scene/pose.hpp"
#include "tests/support/any_camera.hpp"
#include "tests/support/expect_message.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glim {
namespace {

glm::dmat4 matrixOf(const Json& rows, std::size_t size)
{
    glm::dmat4 matrix(1.0);
    for (std::size_t row = 0; row < size; ++row) {
        for (std::size_t column = 0; column < size; ++column) {
            matrix[static_cast<int>(column)][static_cast<int>(row)] = rows.at(row).at(column).number();
        }
    }
    return matrix;
}

TEST(FilmCameraTest, KAndPoseProjectWhatAPixelShowsToThePixel)
{
    Random random(61);
    const glm::dvec2 size(640.0, 360.0);
    for (int i = 0; i < 1000; ++i) {
        Camera camera = anyCamera(random);
        camera.position = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
        camera.yfov = static_cast<float>(random.uniform(0.3, 2.0));
        if (i % 2 == 0) {
            camera.projection.intrinsics =
                Intrinsics{{random.uniform(300, 900), random.uniform(300, 900)}, {random.uniform(200, 400), 170.0}, size};
        }
        camera.projection.shift = i % 3 == 0 ? glm::dvec2(0.0) : glm::dvec2(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
        const glm::dvec3 origin(10.0, -20.0, 30.0);
        const FlatCamera flat = flattenCamera(camera, static_cast<float>(size.x / size.y));
        const glm::dvec2 film(random.uniform(-1, 1), random.uniform(-1, 1)), plane = film + glm::dvec2(flat.projection.shift);
        const glm::dvec3 along = glm::dvec3(flat.forward) + plane.x * glm::dvec3(flat.right) + plane.y * glm::dvec3(flat.up);
        const glm::dvec3 place = origin + glm::dvec3(flat.position) + random.uniform(0.5, 5.0) * along;
        const Json json = *Json::parse(describeFilmCamera(camera, glm::uvec2(size), origin, 0.5));
        const glm::dvec4 seen = glm::inverse(matrixOf(json.at("pose"), 4)) * glm::dvec4(place, 1.0);
        const glm::dvec3 pixel = glm::dmat3(matrixOf(json.at("K"), 3)) * (glm::dvec3(seen.x, -seen.y, -seen.z) / -seen.z);
        const glm::dvec2 expected = 0.5 * size * glm::dvec2(1.0 + film.x, 1.0 - film.y);
        ASSERT_LE(glm::distance(glm::dvec2(pixel), expected), 1e-3) << i;
        EXPECT_EQ(json.at("time").number(), 0.5);
    }
}

TEST(FilmCameraTest, KOfACropCountsFromItsCorner)
{
    Camera camera;
    camera.yfov = 1.0F;
    const Crop crop{{10, 30}, {20, 40}, {200, 100}};
    const glm::dmat3 whole(matrixOf(Json::parse(describeFilmCamera(camera, crop.whole, {}, {}))->at("K"), 3));
    camera.projection.crop = crop;
    const Json json = *Json::parse(describeFilmCamera(camera, crop.size, {}, {}));
    EXPECT_EQ(glm::dmat3(matrixOf(json.at("K"), 3)), whole - glm::dmat3({0, 0, 0}, {0, 0, 0}, {10, 30, 0}));
    EXPECT_EQ(json.at("crop").dump(), "[10,30,20,40]");
    EXPECT_EQ(json.at("whole").dump(), "[200,100]");
}

TEST(FilmCameraTest, ACropIsWithinThePicture)
{
    Projection projection;
    projection.crop = Crop{{10, 30}, {20, 40}};
    EXPECT_EQ(applyProjection({}, projection, {30, 70}).projection.crop->whole, glm::uvec2(30, 70));
    for (const glm::uvec2 size : {glm::uvec2(29, 70), glm::uvec2(30, 69)}) {
        test::expectRefusal<InputError>([&] { applyProjection({}, projection, size); }, MessageId::OutOfRange, {.place = "--crop"});
    }
}

TEST(FilmCameraTest, OpenExrsMatrixIsForRowVectors)
{
    Camera camera;
    camera.position = {1, 2, 3};
    camera.forward = {1, 0, 0};
    camera.right = {0, 0, 1};
    camera.up = {0, 1, 0};
    const auto matrix = worldToCameraOf(describeFilmCamera(camera, {4, 4}, {0, 0, 10}, std::nullopt));
    ASSERT_TRUE(matrix);
    EXPECT_EQ(glm::transpose(*matrix) * glm::vec4(6, 2, 13, 1), glm::vec4(0, 0, -5, 1));
    for (const char* damaged : {"", "pose", "[]", "{}", R"({"pose":3})", R"({"pose":[]})", R"({"pose":[[1,2,3]]})",
                                R"({"pose":[["1",0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})"}) {
        EXPECT_FALSE(worldToCameraOf(damaged)) << damaged;
    }
}

TEST(FilmCameraTest, OnlyWhatAppliesIsSaid)
{
    Camera camera;
    const auto has = [&camera](const char* name) {
        return Json::parse(describeFilmCamera(camera, {4, 4}, glm::dvec3(0.0), std::nullopt))->find(name) != nullptr;
    };
    EXPECT_TRUE(has("K") && !has("time") && !has("distortion") && !has("fisheye") && !has("halfSize"));
    camera.projection.model = Projection::Model::Fisheye;
    EXPECT_TRUE(has("K") && has("fisheye") && !has("distortion"));
    camera.projection.model = Projection::Model::Equirectangular;
    EXPECT_TRUE(!has("K") && has("pose"));
    camera = {};
    camera.kind = Camera::Kind::Orthographic;
    EXPECT_TRUE(!has("K") && has("halfSize"));
}

TEST(FilmCameraTest, OrthographicCamerasHaveNoLens)
{
    Camera camera;
    Projection lens, fisheye, around;
    lens.model = Projection::Model::RadialTangential;
    fisheye.model = Projection::Model::Fisheye;
    around.model = Projection::Model::Equirectangular;
    EXPECT_EQ(applyProjection(camera, fisheye, {4, 4}).projection, fisheye);
    camera.kind = Camera::Kind::Orthographic;
    test::expectRefusal<InputError>([&] { applyProjection(camera, lens, {4, 4}); }, MessageId::Conflict, {.place = "--distortion"});
    test::expectRefusal<InputError>([&] { applyProjection(camera, fisheye, {4, 4}); }, MessageId::Conflict, {.place = "--fisheye"});
    EXPECT_EQ(flattenCamera(applyProjection(camera, around, {4, 4}), 2.0F).kind, kPerspective);
}

}  // namespace
}  // namespace glim
