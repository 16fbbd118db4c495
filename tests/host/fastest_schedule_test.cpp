// --schedule auto on a device that is no software: measured once, in a render that is long enough, and kept unless it is within the noise.
#include "host/job/fastest_schedule.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>

namespace glim::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const ScheduleRates kPersistent{{1e6, 1.1e6, 1e6}, {1.1e6, 1.2e6, 1.3e6}}, kWavefront{{1.1e6}, {1e6}},
    kWithinTheMargin{{1e6, 1e6}, {1.04e6, 1.04e6}}, kWithinTheNoise{{1e6, 1e6, 1e6}, {1.3e6, 1.3e6, 1.04e6}}, kNoClock{};

class FastestScheduleTest : public testing::Test {
protected:
    FastestScheduleTest()
    {
        device_.name = "some GPU";
        device_.driver = "driver 1";
        settings_.width = settings_.height = 64;
        settings_.sampleEnd = 4096;
        use(folder_ / "some" / "cache");
    }
    ~FastestScheduleTest() override { setenv("GLIM_CACHE_DIR", "", 1); }

    void use(const fs::path& cache)
    {
        cache_ = cache;
        setenv("GLIM_CACHE_DIR", cache.c_str(), 1);
    }
    // What is chosen; counts how often it is measured.
    Schedule choose(const ScheduleRates& rates)
    {
        return fastestSchedule(device_, settings_, [&] {
            ++measured_;
            return rates;
        });
    }
    json kept() const { return json::parse(readFileBytes(cache_ / "schedules.json")); }

    ScratchFolder folder_;
    fs::path cache_;
    DeviceDescription device_;
    RenderSettings settings_;
    int measured_ = 0;
};

TEST_F(FastestScheduleTest, IsMeasuredOnceInALongRender)
{
    settings_.sampleEnd = 4095;
    EXPECT_EQ(choose(kPersistent), Schedule::Auto);
    settings_.sampleEnd = 4096;
    settings_.schedule = Schedule::Wavefront;
    EXPECT_EQ(choose(kPersistent), Schedule::Auto);
    settings_.schedule = Schedule::Auto;
    settings_.course.accelerator = Accelerator::None;
    EXPECT_EQ(choose(kPersistent), Schedule::Auto);
    settings_.course.accelerator = RenderSettings().course.accelerator;
    EXPECT_EQ(measured_, 0);
    EXPECT_FALSE(fs::exists(cache_));

    EXPECT_EQ(choose(kPersistent), Schedule::Persistent);
    EXPECT_EQ(choose(kWavefront), Schedule::Persistent) << "it is known";
    EXPECT_EQ(measured_, 1);
    const json entry = kept().at("some GPU, driver 1");
    EXPECT_EQ(entry.at("fastest"), "persistent");
    device_.driver = "driver 2";
    EXPECT_EQ(choose(kWavefront), Schedule::Wavefront);
    EXPECT_EQ(measured_, 2);
    EXPECT_EQ(kept().at("some GPU, driver 1"), entry);
    EXPECT_EQ(rememberedSchedule(device_), Schedule::Wavefront);
}

TEST_F(FastestScheduleTest, WhatIsWithinTheNoiseIsNotKept)
{
    for (const ScheduleRates& rates : {kWithinTheMargin, kWithinTheNoise, kNoClock}) {
        EXPECT_EQ(choose(rates), Schedule::Auto);
        EXPECT_FALSE(fs::exists(cache_ / "schedules.json"));
    }
    EXPECT_EQ(measured_, 3) << "each render tries again";
}

// The load of the machine is in a software device's times, and another than the one that chose here may have written the file.
TEST_F(FastestScheduleTest, OfASoftwareDeviceIsNeitherMeasuredNorRead)
{
    EXPECT_EQ(choose(kWavefront), Schedule::Wavefront);
    device_.software = true;
    EXPECT_EQ(choose(kWavefront), Schedule::Auto);
    EXPECT_EQ(rememberedSchedule(device_), Schedule::Auto);
    EXPECT_EQ(measured_, 1);
    RenderSettings settings;
    settings.fastest = rememberedSchedule(device_);
    EXPECT_EQ(chooseSchedule(settings, device_), Schedule::Persistent);
}

TEST_F(FastestScheduleTest, ABrokenFileIsMeasuredAgain)
{
    fs::create_directories(cache_);
    for (const char* text : {"{", "[]"}) {
        writeText(cache_ / "schedules.json", text);
        EXPECT_EQ(choose(kPersistent), Schedule::Persistent) << text;
        EXPECT_EQ(kept().size(), 1U) << text;
    }
    EXPECT_EQ(measured_, 2);
    const std::string key = kept().begin().key();
    json older = kept().at(key);
    older.at("version") = "glim 0.0.1";
    for (const json& entry : {json("text"), json{{"fastest", 7}}, older}) {
        writeText(cache_ / "schedules.json", json{{"another device", 1}, {key, entry}}.dump());
        EXPECT_EQ(choose(kWavefront), Schedule::Wavefront) << entry;
        EXPECT_TRUE(kept().at(key).is_object()) << entry;
        EXPECT_EQ(kept().at("another device"), 1);
    }
    EXPECT_EQ(measured_, 5);
}

TEST_F(FastestScheduleTest, NothingIsMeasuredThatCannotBeKept)
{
    writeText(folder_ / "file", "");
    for (const fs::path& cache : {folder_ / "file" / "cache", fs::path()}) {
        use(cache);
        EXPECT_EQ(choose(kPersistent), Schedule::Auto);
    }
    EXPECT_EQ(measured_, 0);
}

}  // namespace
}  // namespace glim::test
