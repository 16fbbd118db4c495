#include "host/render/settings.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

TEST(SettingsTest, SmallPicturesHaveThePicturesShape)
{
    RenderSettings settings;
    settings.width = 1920;
    settings.height = 1080;
    EXPECT_EQ(pilotSize(settings, 1024.0), glm::uvec2(43, 24));
    EXPECT_EQ(pilotSizeAtMost(settings, 1024.0), glm::uvec2(43, 24));
    settings.width = 4000;
    settings.height = 1;
    EXPECT_EQ(pilotSize(settings, 1000.0), glm::uvec2(2000, 1)) << "at least a pixel";
    settings.width = 30;
    settings.height = 20;
    EXPECT_EQ(pilotSize(settings, 2400.0), glm::uvec2(60, 40));
    EXPECT_EQ(pilotSizeAtMost(settings, 2400.0), glm::uvec2(30, 20)) << "no more pixels than there are";
}

}  // namespace
}  // namespace glim
