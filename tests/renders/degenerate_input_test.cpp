// H2, H44: input without meaning is refused with a sentence or has a defined meaning, and no pixel of it is NaN.
#include "tests/support/gltf_builder.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glim::test {
namespace {

using nlohmann::json;

GltfBuilder withTriangle(const json& node = json::object())
{
    GltfBuilder builder;
    json placed = node;
    placed["mesh"] = builder.addTriangleMesh();
    builder.addNode(placed);
    return builder;
}

// With a sound triangle beside it, so that there is something to draw.
GltfBuilder besideTriangle(const std::vector<float>& positions)
{
    GltfBuilder builder = withTriangle();
    builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", builder.addVec3(positions)}}}})}});
    return builder;
}

void addLight(GltfBuilder& builder, double intensity)
{
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = json::array({{{"type", "point"}, {"intensity", intensity}}});
    builder.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
}

std::size_t countNan(const Film& film)
{
    std::size_t count = 0;
    for (const PixelMoments& pixel : film.pixels) {
        count += std::isfinite(pixel.mean.r) && std::isfinite(pixel.squares.r) ? 0 : 1;
    }
    return count;
}

TEST(DegenerateInputTest, H44IsRefusedOrRendered)
{
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    GltfBuilder dark = withTriangle(), shining = withTriangle({{"scale", {-1, 1, 1}}});
    addLight(dark, 0.0);
    addLight(shining, 1.0);
    struct Refused {
        GltfBuilder builder;
        MessageId id;
        const char* value;
    };
    const std::vector<Refused> refused = {{besideTriangle({0, 0, 0, nan, 0, 0, 0, 1, 0}), MessageId::OutOfRange, "nan"},
                                          {besideTriangle({0, 0, 0, infinity, 0, 0, 0, 1, 0}), MessageId::OutOfRange, "inf"},
                                          {withTriangle({{"scale", {1e39, 1e39, 1e39}}}), MessageId::TooLarge, "1e+39"}};
    for (const auto& [builder, id, value] : refused) {
        expectRefused(builder, id, {.value = value});
    }
    const std::vector<std::pair<const char*, GltfBuilder>> rendered = {
        {"negative determinant", shining},
        {"no light", dark},
        {"empty mesh", besideTriangle({})},
        {"coincident corners", besideTriangle({0, 0, 1, 0, 0, 1, 0, 1, 1})},
        {"collinear corners", besideTriangle({0, 0, 1, 1, 0, 1, 2, 0, 1})},
        {"zero scale", withTriangle({{"scale", {0, 0, 0}}})},
        {"singular matrix", withTriangle({{"matrix", {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}})},
        {"a sliver", besideTriangle({0, 0, 1, 1, 0, 1, 0.5F, 1e-30F, 1})},
        {"nearly nothing", withTriangle({{"scale", {1e-20, 1e-20, 1e-20}}})},
        {"nearly everything", withTriangle({{"scale", {1e15, 1e15, 1e15}}})}};
    for (const auto& [name, builder] : rendered) {
        LoadOptions options;
        options.environment = glm::vec3(1.0F);
        const Film film = renderScene(load(builder, options), squareSettings(16, 32));
        EXPECT_EQ(countNan(film), 0U) << name;
    }
    printHardCase("H44", "NaN, infinities, singular nodes, no light, ...", static_cast<double>(refused.size() + rendered.size()),
                  std::to_string(refused.size()) + " refused, the others without NaN");
}

}  // namespace
}  // namespace glim::test
