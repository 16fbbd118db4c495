#include "host/render/path_buffers.hpp"
#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace glim {
namespace {

constexpr std::uint32_t kSlots = 200;

template <class T>
T last(const PathBuffers& paths, std::uint32_t binding)
{
    return download<T>(*paths.buffers(0).at(binding), kSlots).back();
}

std::vector<uint> sortedQueue(const PathBuffers& paths, std::uint32_t binding)
{
    std::vector<uint> queue = download<uint>(*paths.buffers(0).at(binding), kSlots);
    std::sort(queue.begin(), queue.end());
    return queue;
}

TEST(PathsTest, StructsReadOnTheHostAsTheDeviceWroteThem)
{
    const PathBuffers paths(testDevice(), kSlots);
    KernelTest(test_kernels::paths_test).buffers(paths.buffers(0)).threads(kSlots).run();
    const float x = 100.0F * (kSlots - 1);
    const PathRay ray = last<PathRay>(paths, kBindRays);
    EXPECT_EQ(ray.origin, vec3(x, x + 1, x + 2));
    EXPECT_EQ(ray.source, kSlots + 2);
    const PathHit hit = last<PathHit>(paths, kBindHits);
    EXPECT_EQ(hit.t, x + 1);
    EXPECT_EQ(hit.barycentric, vec2(x + 2, x + 3));
    const PathState state = last<PathState>(paths, kBindStates);
    EXPECT_EQ(state.pdf, x + 3);
    EXPECT_EQ(state.cosine, x + 4);
    const FirstHit first = last<FirstHit>(paths, kBindFirstHits);
    EXPECT_EQ(first.normal, vec3(x + 4, x + 5, x + 6));
    EXPECT_EQ(first.depth, x + 7);
    const ShadowRay shadow = last<ShadowRay>(paths, kBindShadowRays);
    EXPECT_EQ(shadow.target, kSlots + 1);
    EXPECT_EQ(shadow.reach, x + 4);
}

TEST(PathsTest, QueuesHoldEverySlotOnce)
{
    const PathBuffers paths(testDevice(), kSlots);
    KernelTest(test_kernels::paths_test).buffers(paths.buffers(0)).threads(kSlots).run();
    std::vector<uint> slots(kSlots);
    std::iota(slots.begin(), slots.end(), 0U);
    EXPECT_EQ(sortedQueue(paths, kBindNextQueue), slots);
    std::iota(slots.begin(), slots.end(), 1U);
    EXPECT_EQ(sortedQueue(paths, kBindShadowQueue), slots);
    EXPECT_EQ(download<QueueTails>(paths.queueTails(), 1)[0].next, kSlots);
}

TEST(PathsTest, ParitySwapsTheQueues)
{
    const PathBuffers paths(testDevice(), kSlots);
    EXPECT_EQ(paths.buffers(0).at(kBindActiveQueue), paths.buffers(1).at(kBindNextQueue));
    EXPECT_EQ(paths.buffers(0).at(kBindNextQueue), paths.buffers(1).at(kBindActiveQueue));
}

}  // namespace
}  // namespace glim
