// A path's records are its own: it clears them, numbers them from 1 on, and sums up the light of each.
#include "shaders/shared/bindings.h"
#include "shaders/shared/guide_types.h"
#include "shaders/shared/luminance.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace glim::guide_records_test {

struct Case {
    std::uint32_t opened;
    float lit, sampled;
    vec3 light, direct;
};

TEST(GuideRecordsTest, LightComesToTheRecordOfItsNumber)
{
    Random random(6);
    const auto color = [&] { return vec3{random.unitFloat(), random.unitFloat(), random.unitFloat()}; };
    std::vector<Case> cases;
    for (std::uint32_t i = 0; i < 500; ++i) {
        const std::uint32_t opened = i % (kGuideRecords + 1);
        const auto number = [&] { return static_cast<float>(random.below(opened + 1)); };
        cases.push_back({opened, number(), number(), color(), color()});
    }
    Buffer records(testDevice(), "test's records", BufferKind::Storage, cases.size() * kGuideRecords * sizeof(GuideRecord));
    upload(records, std::span<const GuideRecord>(
                        std::vector<GuideRecord>(cases.size() * kGuideRecords, GuideRecord{vec3(9.0F), 9.0F, 9, 9, 9.0F, 9})));
    KernelTest(test_kernels::guide_records_test).cases(cases).buffers({{kBindGuideRecords, &records}}).run();
    const auto found = download<GuideRecord>(records, cases.size() * kGuideRecords);
    for (std::uint32_t slot = 0; slot < cases.size(); ++slot) {
        const Case& c = cases[slot];
        for (std::uint32_t i = 1; i <= kGuideRecords; ++i) {
            const GuideRecord& record = found[slot * kGuideRecords + i - 1];
            if (i > c.opened) {
                EXPECT_EQ(record.throughput, 0.0F) << "nothing of the path before";
                continue;
            }
            const float number = static_cast<float>(i);
            EXPECT_EQ(record.point, vec3(number));
            EXPECT_EQ(record.direction, i);
            EXPECT_EQ(record.normal, slot);
            EXPECT_EQ(record.throughput, 1.0F);
            EXPECT_NEAR(static_cast<double>(record.value), 0.5 + (c.lit == number ? 2.0 * computeLuminance(c.light) : 0.0), 1e-6);
            EXPECT_EQ(record.direct & kSampledLights, i) << "of which lights the sample is";
            EXPECT_EQ((record.direct & kSampleBlocked) != 0, c.sampled != number) << "until it arrives";
            const double sampled = static_cast<double>(std::bit_cast<float>(record.direct & ~(kSampledLights | kSampleBlocked)));
            EXPECT_NEAR(sampled, c.sampled == number ? computeLuminance(c.direct) : 0.25, 3e-6);
        }
    }
}

}  // namespace glim::guide_records_test
