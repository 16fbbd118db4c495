// The same geometry in several containers gives the same picture, or one that differs by its quantization only.
#include "tests/support/compress_geometry.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

namespace glim::test {
namespace {

Scene hillsIn(const AddGeometry& add)
{
    GltfBuilder builder = build(makeHills(20), add);
    builder.document["meshes"][0]["primitives"][0]["material"] =
        builder.append("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0.25}, {"roughnessFactor", 0.5}}}});
    return load(builder, litByTheSky());
}

TEST(CompressedScene, EqualContainersGiveEqualFilms)
{
    const RenderSettings settings = squareSettings(16, 256);
    const Film plain = renderScene(hillsIn(addPlain), settings);
    EXPECT_TRUE(sameBits(renderScene(hillsIn(meshopt("INDICES")), settings), plain));
    EXPECT_TRUE(sameBits(renderScene(hillsIn(draco({.edgebreaker = false})), settings), plain));
    const Film quantized = renderScene(hillsIn(draco({.quantizationBits = 14})), settings);
    EXPECT_FALSE(sameBits(quantized, plain)) << "a test of nothing";
    expectSameMean("hills in Draco with 14 bits", quantized, plain);
}

}  // namespace
}  // namespace glim::test
