// What the window shows of the guide under the mouse. Apart from preview_guiding_test, as a sanitizer of threads would take minutes to
// learn this guide.
#include "tests/support/preview_fixture.hpp"

#include <cmath>
#include <numbers>

namespace glim::test {
namespace {

// Two rooms with a slit between them. At a point of the dark one's floor the densest directions, which the inset draws red, go through it.
TEST_F(PreviewTest, TheInsetPointsAtTheSlit)
{
    constexpr int kColumns = 256, kRows = 128, kMargin = 8;  // pixels of the map, and of the panel around it
    width = 300;
    height = 240;
    scene = sceneFile("door_ajar.gltf");
    const Pixels window =
        windowAtWriting(screen, "0 key G\n0 samples 4\n0 click 40,215\n0.3 click 200,215\n0.3 key P\n", {"--spp", "4", "--guiding", "on"});
    int count = 0;
    glm::dvec2 sum(0.0);
    for (int y = 0; y < kRows; ++y) {
        for (int x = 0; x < kColumns; ++x) {
            if (window[static_cast<std::size_t>(kMargin + y) * width + width - kMargin - kColumns + x] == std::array{255, 0, 0}) {
                ++count;
                sum += glm::dvec2(x + 0.5, y + 0.5) / glm::dvec2(kColumns, kRows);
            }
        }
    }
    ASSERT_GE(count, kColumns / 64 * kRows / 32) << "a cell";
    const glm::dvec2 red = sum / static_cast<double>(count), cell(1.0 / 64.0, 1.0 / 32.0);

    // The scene's camera, what it sees in the middle of the pixel, and the slit: at x = 4.05 and z = 2, 2 m high.
    const glm::dvec3 from(0.4, 1.5, 0.4), forward = glm::normalize(glm::dvec3(3.2, 1.0, 3.2) - from);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0))), up = glm::cross(right, forward);
    const glm::dvec2 film = std::tan(0.6) * (2.0 * glm::dvec2(200.5, 215.5) - glm::dvec2(width, height)) / static_cast<double>(height);
    const glm::dvec3 ray = forward + film.x * right - film.y * up, floor = from - from.y / ray.y * ray;
    const auto placeOf = [&](const glm::dvec3& point) {
        const glm::dvec3 w = glm::normalize(point - floor);
        return glm::dvec2(0.5 + std::atan2(glm::dot(w, right), glm::dot(w, forward)) / (2.0 * std::numbers::pi),
                          0.5 - std::asin(glm::dot(w, up)) / std::numbers::pi);
    };
    const glm::dvec2 low = placeOf({4.05, 0.0, 2.0}), high = placeOf({4.05, 2.0, 2.0});
    EXPECT_NEAR(red.x, 0.5 * (low.x + high.x), 1.5 * cell.x);
    EXPECT_LT(red.y, low.y + cell.y);
    EXPECT_GT(red.y, high.y - cell.y);
}

}  // namespace
}  // namespace glim::test
