// Guides from records: what they know of, what they leave out.
#include "host/render/build_guide.hpp"
#include "tests/support/guide_records.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

namespace glim::build_guide_test {

GuideNode nodeAt(const Guide& guide, std::uint32_t texel) { return std::bit_cast<GuideNode>(guide.texels[texel]); }

GuideCell cellAt(const Guide& guide, std::uint32_t texel)
{
    return std::bit_cast<GuideCell>(std::array<uvec4, 2>{guide.texels[texel], guide.texels[texel + 1]});
}

std::uint32_t cellsUnder(const Guide& guide, std::uint32_t texel)
{
    const GuideNode node = nodeAt(guide, texel);
    return node.axis == kGuideLeaf ? (node.child > 0 ? 1 : 0) : cellsUnder(guide, node.child) + cellsUnder(guide, node.child + 1);
}

TEST(BuildGuideTest, WithoutRecordsItGuidesNobody)
{
    for (const Guide& guide : {emptyGuide(), guideOf({})}) {
        EXPECT_EQ(guide.cells, 0U);
        ASSERT_EQ(guide.texels.size(), kGuideRoots + 1);
        for (std::uint32_t root = 0; root < kGuideRoots; ++root) {
            EXPECT_EQ(nodeAt(guide, root).axis, kGuideLeaf);
            EXPECT_EQ(nodeAt(guide, root).child, 0U);
        }
    }
    EXPECT_EQ(emptyGuide().digest, guideOf({}).digest);
}

TEST(BuildGuideTest, LeavesOutWhatIsNoRecord)
{
    Random random(1);
    std::vector<GuideRecord> records = recordsOfBall(1000, random);
    const Guide guide = guideOf(records);
    GuideRecord none = records[7];
    none.throughput = 0.0F;
    records.push_back(none);
    for (float GuideRecord::*field : {&GuideRecord::value, &GuideRecord::direct, &GuideRecord::throughput}) {
        for (const float broken : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
            records.push_back(records[7]);
            records.back().*field = broken;
        }
    }
    records.push_back(records[7]);
    records.back().point.y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(guideOf(records).digest, guide.digest);
}

// Two thirds of the points are on one wall, up to rounding: the median is a place within it.
TEST(BuildGuideTest, DividesPointsOfParallelWalls)
{
    Random random(2);
    std::vector<GuideRecord> records = recordsOfBall(60000, random);
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].point.x = (i % 3 != 0 ? -4.0F : 4.0F) + static_cast<float>(3e-6 * random.uniform());
        records[i].normal = encodeDirection({1, 0, 0});
    }
    const Guide guide = guideOf(records);
    EXPECT_GE(cellsUnder(guide, 0), 60000U / 2048U);
    const GuideNode root = nodeAt(guide, 0);
    EXPECT_EQ(root.axis, 0U);
    EXPECT_NEAR(root.split, 0.0F, 3.9F) << "between the walls";
}

TEST(BuildGuideTest, PointsAtOnePlaceAreOneCell)
{
    Random random(2);
    std::vector<GuideRecord> records = recordsOfBall(20000, random);
    for (GuideRecord& record : records) {
        record.point = vec3(1.0F, 2.0F, 3.0F);
        record.normal = encodeDirection({0, 0, -1});
    }
    const Guide guide = guideOf(records);
    EXPECT_EQ(guide.cells, 1U);
    const GuideCell cell = cellAt(guide, nodeAt(guide, 5).child);
    EXPECT_EQ(cell.center, vec3(1.0F, 2.0F, 3.0F));
    EXPECT_EQ(cell.focus, 0.0F) << "there is no parallax";
    EXPECT_EQ(cell.share, 0.7F);
    EXPECT_FLOAT_EQ(cell.radiance, 1.0F) << "of the mean, which it is";
    EXPECT_FLOAT_EQ(cell.reflected, 1.0F);
}

// A ball that is 1.6 m from the centre of the cells' points, in all of whose directions it is seen elsewhere without a focus.
TEST(BuildGuideTest, FocusesOnWhatIsNear)
{
    Random random(4);
    std::vector<GuideRecord> records = recordsOfBall(2000, random);
    for (GuideRecord& record : records) {
        record.point = 0.5F * record.point;
        const glm::dvec3 w = glm::dvec3(1.6, 0.3, -0.4) + 0.05 * random.direction() - glm::dvec3(record.point);
        record.direction = encodeDirection(glm::normalize(w));
        record.normal = encodeDirection({1, 0, 0});
    }
    const Guide guide = guideOf(records);
    ASSERT_EQ(guide.cells, 1U);
    const float focus = cellAt(guide, nodeAt(guide, 0).child).focus;
    EXPECT_GT(focus, 1.1F);
    EXPECT_LT(focus, 2.4F);
}

TEST(BuildGuideTest, FewRecordsGuideNobody)
{
    Random random(5);
    std::vector<GuideRecord> records = recordsOfBall(60, random);
    for (GuideRecord& record : records) {
        record.normal = encodeDirection({0, 1, 0});
    }
    const Guide guide = guideOf(records);
    ASSERT_EQ(guide.cells, 1U);
    const GuideCell cell = cellAt(guide, nodeAt(guide, 2).child);
    EXPECT_EQ(cell.share, 0.0F);
    EXPECT_EQ(cell.quadtree, kUniformQuadtree) << "it has none of its own";
}

}  // namespace glim::build_guide_test
