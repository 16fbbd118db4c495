// Host and device agree on the place of every field of shaders/shared.
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/shared_fields.h"

#include <gtest/gtest.h>

namespace glim::shared_structs_test {

// Words, all of them named in shared_fields.h, without padding.
static_assert(sizeof(PathRay) == 32 && sizeof(PathHit) == 16 && sizeof(PathState) == 32 && sizeof(PathRadiance) == 16);
static_assert(sizeof(FirstHit) == 32 && sizeof(ShadowRay) == 48 && sizeof(Round) == 32);
static_assert(sizeof(RayCounts) == 16 && sizeof(Located) == 8 && sizeof(Status) == 36 + 8 * kMaxLocated);
static_assert(sizeof(BlockSums) == 52 && sizeof(Splat) == 32 && sizeof(Pass) == 32 && sizeof(PixelMoments) == 68);
static_assert(sizeof(PathNote) == 196 && sizeof(BrightestSample) == 8);
static_assert(sizeof(CatcherMoments) == 44 && sizeof(CatcherSums) == 72);
static_assert(sizeof(MaterialData) == 48 && sizeof(LightNode) == 48 && sizeof(FlatLight) == 80 && sizeof(InstanceData) == 80);
static_assert(sizeof(PrincipledData) == 64 && sizeof(LayersData) == 96 && sizeof(MediumData) == 32 && sizeof(ScatteringData) == 16 &&
              sizeof(TextureData) == 48);
static_assert(sizeof(FlatCamera) == 144 && sizeof(DisplayPass) == 52 && sizeof(ViewPass) == 56);
static_assert(sizeof(EverySharedStruct) == 4 * kSharedWords);
static_assert(sizeof(CoursePass) == 56 && sizeof(RenderParameters) == 308 && sizeof(CourseParameters) == 16);
static_assert(sizeof(CoursePass) <= 64 && sizeof(DisplayPass) <= 64 && sizeof(ViewPass) <= 64 && sizeof(GuideProbePass) <= 64,
              "push constants hold what changes from dispatch to dispatch");

TEST(SharedStructsTest, HaveEveryFieldInTheSamePlace)
{
    EverySharedStruct values{};
    uint number = 1000;
#define U(field) values.field = number++;
#define F(field) values.field = static_cast<float>(number++);
#define U2(field) U(field.x) U(field.y)
#define F2(field) F(field.x) F(field.y)
#define U3(field) U2(field) U(field.z)
#define F3(field) F2(field) F(field.z)
#include "tests/support/shared_fields.h"
#undef U
#undef F
    KernelTest test(test_kernels::shared_structs_test);
    test.cases(std::vector<EverySharedStruct>{values}).resultsOf<EverySharedStruct>(1).run();
    values = test.results<EverySharedStruct>()[0];
    number = 1000;
#define U(field) EXPECT_EQ(static_cast<uint>(values.field), number++) << #field;
#define F(field) U(field)
#include "tests/support/shared_fields.h"
    EXPECT_EQ(number, 1000 + kSharedWords);
}

}  // namespace glim::shared_structs_test
