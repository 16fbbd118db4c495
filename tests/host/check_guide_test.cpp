// Trees of guides that come from a file.
#include "host/render/check_guide.hpp"
#include "shaders/shared/guide_types.h"
#include "tests/support/guide_records.hpp"

#include <gtest/gtest.h>

namespace glim::check_guide_test {

using Texels = std::vector<uvec4>;

// With cells below cells, and quadtrees of several levels.
Texels texelsOfBall()
{
    Random random(1);
    return guideOf(recordsOfBall(100'000, random)).texels;
}

TEST(CheckGuideTest, TreesThatAreBuiltAreSound)
{
    EXPECT_TRUE(hasSoundTrees(emptyGuide().texels));
    EXPECT_TRUE(hasSoundTrees(texelsOfBall()));
    EXPECT_TRUE(hasSoundTrees(emptyGuide(true).texels));
}

TEST(CheckGuideTest, SoIsTheTreeOfScatterings)
{
    Texels texels = emptyGuide(true).texels;
    texels[kGuideOfScatterings].w = texels[0].w;
    EXPECT_FALSE(hasSoundTrees(texels)) << "it leads to another tree's block";
}

TEST(CheckGuideTest, NoTexelMayBeMissing)
{
    EXPECT_FALSE(hasSoundTrees({}));
    Texels texels = texelsOfBall();
    texels.pop_back();
    EXPECT_FALSE(hasSoundTrees(texels));
}

TEST(CheckGuideTest, NodesMayNotLeadBackOrOut)
{
    const Texels texels = texelsOfBall();
    const auto withBlock = [&](std::size_t node, std::size_t block) {
        Texels changed = texels;
        changed[node].w = (changed[node].w & 1023U) | static_cast<std::uint32_t>(block << 10U);
        return changed;
    };
    const std::uint32_t block = texels[0].w >> 10U;
    EXPECT_TRUE(hasSoundTrees(withBlock(0, block)));
    EXPECT_FALSE(hasSoundTrees(withBlock(0, 0))) << "to itself";
    EXPECT_FALSE(hasSoundTrees(withBlock(1, block))) << "to the nodes of another tree";
    EXPECT_FALSE(hasSoundTrees(withBlock(0, texels.size() / kGuideBlockTexels))) << "beyond the last texel";
    EXPECT_FALSE(hasSoundTrees(withBlock(0, (1U << 22U) - 1)));
    const std::size_t below = kGuideBlockTexels * std::size_t{block};
    ASSERT_EQ(texels[0].w >> 6U & 1U, 0U) << "the first quarter is a node";
    EXPECT_FALSE(hasSoundTrees(withBlock(below, block))) << "to the block that it is in";
}

TEST(CheckGuideTest, CellsAreTwoTexels)
{
    Texels texels = emptyGuide().texels;
    texels.pop_back();  // of the last cell
    EXPECT_FALSE(hasSoundTrees(texels));
}

TEST(CheckGuideTest, QuadtreesMayNotLeadBackOrOut)
{
    Random random(2);
    std::vector<GuideRecord> records = recordsOfBall(20'000, random);
    for (GuideRecord& record : records) {
        record.point = vec3(1.0F);
        record.normal = encodeDirection({0, 0, -1});
    }
    const Texels texels = guideOf(records).texels;
    const std::size_t cell = kGuideBlockTexels * std::size_t{texels[5].w >> 10U},
                      other = kGuideBlockTexels * std::size_t{texels[4].w >> 10U};
    const std::uint32_t root = texels[cell + 1].x, children = texels[root].w, first = children >> 16U;
    ASSERT_NE(children & 0xffffU, 0U) << "the square is divided";
    EXPECT_TRUE(hasSoundTrees(texels));
    const auto isSound = [&](std::size_t texel, int word, std::uint32_t value) {
        Texels changed = texels;
        changed[texel][word] = value;
        return hasSoundTrees(changed);
    };
    for (const std::size_t outside : {texels.size(), std::size_t{0x7fffffff}, std::size_t{0xffffffff}}) {
        EXPECT_FALSE(isSound(cell + 1, 0, static_cast<std::uint32_t>(outside)));
    }
    EXPECT_FALSE(isSound(cell + 1, 0, 0)) << "to a node of the other trees";
    EXPECT_FALSE(isSound(other + 1, 0, root)) << "of two cells";
    EXPECT_TRUE(isSound(cell + 1, 0, kUniformQuadtree)) << "that of all cells that know nothing";
    EXPECT_FALSE(isSound(root, 3, children & 0xffffU)) << "to itself";
    EXPECT_FALSE(isSound(root, 3, children | 0xffff0000U)) << "beyond the last texel";
    EXPECT_FALSE(isSound(root + first, 3, (first << 16U) | 1U)) << "back";
    EXPECT_FALSE(isSound(kUniformQuadtree, 3, 0xffff0001U)) << "where no cell is known";
}

}  // namespace glim::check_guide_test
