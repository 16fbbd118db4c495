#include "host/render/robust_radiance.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace glim {
namespace {

using Values = std::vector<glm::vec3>;

// 3x3 pixels of 1 with a variance of 0.01 around one of `value` with `variance`, in the green channel; the others are 0.
glm::dvec3 likelyInTheMiddle(float value, float variance)
{
    Values radiance(9, glm::vec3(0.0F, 1.0F, 0.0F)), variances(9, glm::vec3(0.0F, 0.01F, 0.0F));
    radiance[4].g = value;
    variances[4].g = variance;
    return robustRadiance(3, 3, radiance, variances)[4];
}

TEST(LikelyRadianceTest, IsTheNeighboursWhereTheExcessMayBeNoise)
{
    EXPECT_EQ(likelyInTheMiddle(5.0F, 16.0F), glm::dvec3(0.0, 1.0, 0.0)) << "one standard error above";
    EXPECT_EQ(likelyInTheMiddle(5.0F, 4.1F).g, 1.0) << "nearly two";
    EXPECT_EQ(likelyInTheMiddle(5.0F, 3.9F).g, 5.0) << "more than two";
    EXPECT_EQ(likelyInTheMiddle(0.5F, 16.0F).g, 0.5) << "below";
    EXPECT_EQ(likelyInTheMiddle(5.0F, 0.0F).g, 5.0) << "no noise";
}

TEST(LikelyRadianceTest, AsksNeighboursThatAreThereAndFinite)
{
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    Values radiance{glm::vec3(5.0F), glm::vec3(1.0F), glm::vec3(nan), glm::vec3(3.0F)}, variance(4, glm::vec3(9.0F));
    EXPECT_EQ(robustRadiance(2, 2, radiance, variance)[0], glm::dvec3(2.0));
    EXPECT_EQ(robustRadiance(4, 1, radiance, variance)[0], glm::dvec3(1.0)) << "one neighbour";
    EXPECT_EQ(robustRadiance(1, 1, {glm::vec3(5.0F)}, {glm::vec3(9.0F)})[0], glm::dvec3(5.0)) << "none";
    variance[0] = glm::vec3(nan, infinity, 9.0F);
    EXPECT_EQ(robustRadiance(2, 2, radiance, variance)[0], glm::dvec3(5.0, 2.0, 2.0)) << "of unknown noise, and of any";
    EXPECT_EQ(robustRadiance(2, 2, radiance, {})[0], glm::dvec3(5.0)) << "no variance";
}

}  // namespace
}  // namespace glim
