// The kernel itself, over queues of known length.
#include "host/gpu/commands.hpp"
#include "host/render/path_buffers.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"
#include "shaders/shared/path_types.h"
#include "tests/support/parameters_buffer.hpp"
#include "tests/support/test_device.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

constexpr std::uint32_t kWorkgroup = 64, kPathsPerThread = 3;

struct Outcome {
    QueueSizes sizes;
    QueueTails tails;
    RayCounts counts;
    std::uint32_t overflows;
};

Outcome sizeDispatch(const Pass& pass, const QueueTails& tails, const RayCounts& counts)
{
    const KernelLayout layout(testDevice(), kernelSlots(), sizeof(CoursePass));
    const Kernel kernel(layout, kernels::size_dispatch, {{kSpecWorkgroup, kWorkgroup}, {kSpecPathsPerThread, kPathsPerThread}});
    PathBuffers paths(testDevice(), 1);
    Buffer tailsBuffer(testDevice(), "test's tails", BufferKind::Storage, sizeof(QueueTails));
    Buffer countsBuffer(testDevice(), "test's counts", BufferKind::Storage, sizeof(RayCounts));
    upload(tailsBuffer, std::span<const QueueTails>(&tails, 1));
    upload(countsBuffer, std::span<const RayCounts>(&counts, 1));
    std::map<std::uint32_t, const Buffer*> bound = paths.buffers(0);
    bound[kBindQueueTails] = &tailsBuffer;
    bound[kBindRayCounts] = &countsBuffer;
    const Buffer parameters = parametersBuffer(anyParameters());
    bound[kBindParameters] = &parameters;
    const Bindings bindings(layout, bound);
    Commands commands(testDevice());
    commands.dispatch(kernel, bindings, std::as_bytes(std::span<const Pass, 1>(&pass, 1)), 1);
    commands.submitAndWait();
    return {download<QueueSizes>(paths.queueSizes(), 1)[0], download<QueueTails>(tailsBuffer, 1)[0],
            download<RayCounts>(countsBuffer, 1)[0], download<Status>(paths.status(), 1)[0].overflows};
}

Pass passAt(std::uint32_t bounce)
{
    Pass pass{};
    pass.pixelCount = 1000;
    pass.sampleCount = 3;
    pass.bounce = bounce;
    pass.sizes = kSizesPaths | kSizesShadow;
    return pass;
}

TEST(SizeDispatchTest, StartsWithAllSlots)
{
    const Outcome outcome = sizeDispatch(passAt(0), {5, 0}, {});
    EXPECT_EQ(outcome.sizes.closest, 3000U);
    EXPECT_EQ(outcome.sizes.shadow, 0U);
    EXPECT_EQ(outcome.sizes.closestGroups, uvec3(47, 1, 1));
    EXPECT_EQ(outcome.sizes.shadowGroups, uvec3(0, 1, 1));
    EXPECT_EQ(outcome.tails.next, 0U);
    EXPECT_EQ(outcome.counts.closest, uvec2(3000, 0));
    EXPECT_EQ(outcome.overflows, 0U);
}

TEST(SizeDispatchTest, CountsWhatIsBeyondTheSlots)
{
    const Outcome outcome = sizeDispatch(passAt(1), {3000, 3002}, {});
    EXPECT_EQ(outcome.sizes.closest, 3000U);
    EXPECT_EQ(outcome.sizes.shadow, 3000U);
    EXPECT_EQ(outcome.overflows, 2U);
    EXPECT_EQ(sizeDispatch(passAt(1), {3001, 3000}, {}).overflows, 1U);
}

TEST(SizeDispatchTest, FollowsTheTailsAndCarriesCounts)
{
    const Outcome outcome = sizeDispatch(passAt(2), {64, 65}, {uvec2(0xffffffff, 7), uvec2(0xffffffff - 65, 0)});
    EXPECT_EQ(outcome.sizes.closest, 64U);
    EXPECT_EQ(outcome.sizes.shadow, 65U);
    EXPECT_EQ(outcome.sizes.closestGroups, uvec3(1, 1, 1));
    EXPECT_EQ(outcome.sizes.shadowGroups, uvec3(2, 1, 1));
    EXPECT_EQ(outcome.tails.next, 0U);
    EXPECT_EQ(outcome.tails.shadow, 0U);
    EXPECT_EQ(outcome.counts.closest, uvec2(63, 8));
    EXPECT_EQ(outcome.counts.shadow, uvec2(0xffffffff, 0));
}

TEST(SizeDispatchTest, SharesCountNoRays)
{
    Pass pass = passAt(0);
    pass.sizes = kSizesShares;
    const Outcome all = sizeDispatch(pass, {5, 6}, {});
    EXPECT_EQ(all.sizes.closest, 3000U);
    EXPECT_EQ(all.sizes.closestGroups, uvec3((3000 + kWorkgroup * kPathsPerThread - 1) / (kWorkgroup * kPathsPerThread), 1, 1));
    EXPECT_EQ(all.counts.closest, uvec2(0, 0));
    EXPECT_EQ(all.tails.next, 0U);
    EXPECT_EQ(all.tails.shadow, 6U);
    pass.bounce = 1;
    EXPECT_EQ(sizeDispatch(pass, {5, 0}, {}).sizes.closest, 5U);
    EXPECT_EQ(sizeDispatch(pass, {3001, 0}, {}).overflows, 1U);
}

TEST(SizeDispatchTest, LeavesTheOtherQueueAlone)
{
    Pass pass = passAt(1);
    pass.sizes = kSizesPaths;
    const Outcome paths = sizeDispatch(pass, {64, 65}, {});
    EXPECT_EQ(paths.sizes.closest, 64U);
    EXPECT_EQ(paths.sizes.shadow, 0U);
    EXPECT_EQ(paths.tails.shadow, 65U);
    EXPECT_EQ(paths.counts.shadow, uvec2(0, 0));
    pass.sizes = kSizesShadow;
    const Outcome shadow = sizeDispatch(pass, {64, 65}, {});
    EXPECT_EQ(shadow.sizes.closest, 0U);
    EXPECT_EQ(shadow.sizes.shadow, 65U);
    EXPECT_EQ(shadow.tails.next, 64U);
    EXPECT_EQ(shadow.counts.closest, uvec2(0, 0));
}

}  // namespace
}  // namespace glim
