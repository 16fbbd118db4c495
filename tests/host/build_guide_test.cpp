// Guides from records: what they know of, what they leave out.
#include "host/render/build_guide.hpp"
#include "shaders/shared/path_types.h"
#include "tests/support/guide_records.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace glim::build_guide_test {

GuideNode nodeAt(const Guide& guide, std::uint32_t texel) { return std::bit_cast<GuideNode>(guide.texels[texel]); }

GuideCell cellAt(const Guide& guide, std::uint32_t texel)
{
    return std::bit_cast<GuideCell>(std::array<uvec4, 2>{guide.texels[texel], guide.texels[texel + 1]});
}

// Of a root that is not divided.
GuideCell onlyCell(const Guide& guide, std::uint32_t root)
{
    const GuideNode node = nodeAt(guide, root);
    EXPECT_EQ(node.children & 3U, kGuideNoSplit);
    EXPECT_NE(node.children >> 6U & 1U, 0U) << "the first quarter is a cell";
    return cellAt(guide, kGuideBlockTexels * (node.children >> 10U));
}

TEST(BuildGuideTest, WithoutRecordsItGuidesNobody)
{
    for (const Guide& guide : {emptyGuide(), guideOf({})}) {
        EXPECT_EQ(guide.cells, 0U);
        for (std::uint32_t root = 0; root < kGuideRoots; ++root) {
            const GuideCell cell = onlyCell(guide, root);
            EXPECT_EQ(cell.quadtree, kUniformQuadtree);
            EXPECT_EQ(cell.focus, 0.0F);
            EXPECT_EQ(cell.sight, 0U);
            EXPECT_EQ(cell.radiance, 1.0F);
            EXPECT_EQ(cell.reflected, 0.0F);
        }
    }
    EXPECT_EQ(emptyGuide().digest, guideOf({}).digest);
}

// They have a tree of their own, after which the others are as before.
TEST(BuildGuideTest, KnowsOfScatteringsIfItIsAskedTo)
{
    Random random(3);
    const std::vector<GuideRecord> records = recordsOfBall(60000, random);
    std::vector<GuideRecord> scattered = records;
    for (GuideRecord& record : scattered) {
        record.normal = kNoReceiverNormal;
    }
    EXPECT_EQ(guideOf(scattered).digest, emptyGuide().digest);
    const Guide surfaces = guideOf(records, true), both = guideOf(scattered, true);
    EXPECT_EQ(onlyCell(surfaces, kGuideOfScatterings).quadtree, kUniformQuadtree);
    EXPECT_EQ(onlyCell(both, 0).quadtree, kUniformQuadtree);
    EXPECT_GE(both.cells, 60000U / 2048U);
    EXPECT_TRUE(guideScatterings(both.texels));
    EXPECT_FALSE(guideScatterings(guideOf(records).texels));
}

TEST(BuildGuideTest, LeavesOutWhatIsNoRecord)
{
    Random random(1);
    std::vector<GuideRecord> records = recordsOfBall(1000, random);
    const Guide guide = guideOf(records);
    GuideRecord none = records[7];
    none.throughput = 0.0F;
    records.push_back(none);
    for (float GuideRecord::*field : {&GuideRecord::value, &GuideRecord::throughput}) {
        for (const float broken : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
            records.push_back(records[7]);
            records.back().*field = broken;
            records.push_back(records[7]);
            records.back().direct = std::bit_cast<std::uint32_t>(broken);
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
    EXPECT_GE(guide.cells, 60000U / 2048U);
    const GuideNode root = nodeAt(guide, 0);
    EXPECT_EQ(root.children & 3U, 0U);
    EXPECT_NEAR(root.split, 0.0F, 3.9F) << "between the walls";
}

// Half of the points are on a wall between two others.
TEST(BuildGuideTest, DividesPointsBesideAWallInTheMiddle)
{
    Random random(2);
    std::vector<GuideRecord> records = recordsOfBall(60000, random);
    for (std::size_t i = 0; i < records.size(); ++i) {
        const float wall = i % 4 == 0 ? -4.0F : i % 4 == 1 ? 4.0F : 0.0F;
        records[i].point.x = wall + static_cast<float>(3e-6 * random.uniform());
        records[i].normal = encodeDirection({1, 0, 0});
    }
    const GuideNode root = nodeAt(guideOf(records), 0);
    EXPECT_EQ(root.children & 3U, 0U);
    EXPECT_NEAR(std::abs(root.split), 2.0F, 1e-3F) << "in the middle of a gap";
}

// Of two neighbouring numbers the mean is one of them.
TEST(BuildGuideTest, DividesPointsThatAreAnUlpApart)
{
    for (const float low : {1.0F, std::nextafter(1.0F, 2.0F)}) {
        for (const int part : {2, 50}) {
            Random random(2);
            std::vector<GuideRecord> records = recordsOfBall(20000, random);
            for (std::size_t i = 0; i < records.size(); ++i) {
                records[i].point = vec3(i % part == 0 ? low : std::nextafter(low, 2.0F), 2.0F, 3.0F);
                records[i].normal = encodeDirection({0, 0, -1});
            }
            EXPECT_EQ(guideOf(records).cells, 2U);
        }
    }
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
    const GuideCell cell = onlyCell(guide, 5);
    EXPECT_EQ(cell.center, vec3(1.0F, 2.0F, 3.0F));
    EXPECT_EQ(cell.focus, 0.0F) << "there is no parallax";
    EXPECT_GT(cell.quadtree, kUniformQuadtree);
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
    const float focus = onlyCell(guide, 0).focus;
    EXPECT_GT(focus, 1.1F);
    EXPECT_LT(focus, 2.4F);
}

// Of lights: those of part 0 always arrive, those of part 3 never, infinite ones every fourth time.
TEST(BuildGuideTest, KnowsWhichLightsAreSeen)
{
    Random random(6);
    std::vector<GuideRecord> records = recordsOfBall(2000, random);
    for (std::size_t i = 0; i < records.size(); ++i) {
        const std::uint32_t lights = i % 3 == 0 ? 0 : i % 3 == 1 ? 3 : kSightOfInfinite;
        const bool arrives = lights == 0 || (lights == kSightOfInfinite && i % 12 == 2);
        records[i].normal = encodeDirection({0, 1, 0});
        records[i].direct = packDirect(1.0F, lights, arrives);
    }
    const GuideCell cell = onlyCell(guideOf(records), 2);
    EXPECT_EQ(computeSight(cell.sight, 0), 1.0F);
    EXPECT_EQ(computeSight(cell.sight, 1), 1.0F) << "of which nothing is known";
    EXPECT_LT(computeSight(cell.sight, 3), 0.1F);
    EXPECT_GT(computeSight(cell.sight, 3), 0.0F);
    EXPECT_FLOAT_EQ(computeSight(cell.sight, kSightOfInfinite), 0.70710678F) << "the root of a quarter, and of what three records may hide";
    EXPECT_FLOAT_EQ(computeSight(cell.sight, kSightOfFinite), 1.0F) << "half";
    EXPECT_EQ(lightSampleShare(cell.sight), 1.0F);
    // 1.25 / 3 of the records have 1, all have 1 from the next ray.
    EXPECT_FLOAT_EQ(cell.radiance, 1.0F);
    EXPECT_FLOAT_EQ(cell.reflected, 1.0F);
    for (GuideRecord& record : records) {
        record.direct |= kSampleBlocked;
    }
    const GuideCell dark = onlyCell(guideOf(records), 2);
    EXPECT_EQ(lightSampleShare(dark.sight), 0.125F);
    EXPECT_LT(computeSight(dark.sight, kSightOfFinite), 0.1F);
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
    const GuideCell cell = onlyCell(guide, 2);
    EXPECT_EQ(cell.quadtree, kUniformQuadtree) << "it has none of its own";
}

}  // namespace glim::build_guide_test
