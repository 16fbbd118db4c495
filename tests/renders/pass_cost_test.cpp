// What a pass costs beside its kernels, counted without a clock: on a GPU the device idles while the host submits, waits and copies.
#include "host/flatten/flatten_scene.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/vulkan_calls.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace glim::test {
namespace {

struct PassCost {
    std::uint64_t passes = 0;
    VulkanCalls calls;
};

// Some 64 passes of which the last half is even.
RenderSettings manyPasses(Schedule schedule)
{
    RenderSettings settings = squareSettings(64, 128);
    settings.schedule = schedule;
    settings.pathCapacity = 1U << 13U;
    settings.uncheckedSeconds = 1e9;
    settings.caustics = false;
    return settings;
}

// Of the passes of samples 64 to 128, some 32, after those before have shown how many surfaces paths meet.
PassCost costOf(Device& device, Schedule schedule)
{
    const Scene scene = mixedScene();
    Renderer renderer(device, flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), manyPasses(schedule));
    const auto always = [] { return true; };
    while (renderer.plan().sampleCount() < 64) {
        renderer.advance(always);
    }
    const VulkanCalls before = vulkanCalls();
    PassCost cost;
    for (; renderer.advance(always); ++cost.passes) {
    }
    cost.calls = vulkanCalls() - before;
    std::cout << getName(schedule) << ": " << cost.passes << " passes, " << cost.calls.submits << " submissions, " << cost.calls.waits
              << " waits, " << cost.calls.dispatches << " dispatches, " << cost.calls.barriers << " barriers, " << cost.calls.copies
              << " copies\n";
    return cost;
}

class PassCostTest : public testing::TestWithParam<Schedule> {};

void expectOneWaitAPass(const PassCost& cost)
{
    EXPECT_GE(cost.passes, 16U);
    EXPECT_GE(cost.calls.waits, cost.passes);
    EXPECT_LE(cost.calls.waits, cost.passes + cost.passes / 4) << "paths may be longer than those of the passes before, rarely";
    EXPECT_EQ(cost.calls.submits, cost.calls.waits);
    EXPECT_EQ(cost.calls.objects, 0U) << "submissions use the objects of earlier ones";
}

TEST_P(PassCostTest, WhereMemoryIsSharedNothingIsCopied)
{
    const PassCost cost = costOf(testDevice(), GetParam());
    expectOneWaitAPass(cost);
    if (isSoftware(testDevice().description().deviceClass)) {
        EXPECT_EQ(cost.calls.copies, 0U);
        EXPECT_EQ(cost.calls.barriers, cost.calls.dispatches + 2 * cost.calls.waits) << "the rounds' sizes, and for the host";
    }
}

// Rounds, ray counts, status and note.
TEST_P(PassCostTest, ADeviceWithMemoryOfItsOwnCopiesFourSmallBuffersBeforeEachWait)
{
    const VulkanInstance instance;
    Device device(instance, std::nullopt, VK_NULL_HANDLE, DeviceClass::DiscreteGpu);
    const PassCost cost = costOf(device, GetParam());
    expectOneWaitAPass(cost);
    EXPECT_EQ(cost.calls.copies, 4 * cost.calls.waits);
    EXPECT_EQ(cost.calls.barriers, cost.calls.dispatches + 2 * cost.calls.waits);
}

// While the host records and submits a pass, the device traces the one before: between passes one is not waited for.
TEST_P(PassCostTest, TheDeviceHasThePassAfterTheOneThatTheHostWaitsFor)
{
    const Scene scene = mixedScene();
    Renderer renderer(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), manyPasses(GetParam()));
    const VulkanCalls before = vulkanCalls();
    std::uint64_t passes = 0, ahead = 0;
    renderer.render([&](const RenderProgress& now) {
        const VulkanCalls calls = vulkanCalls() - before;
        EXPECT_LE(calls.submits - calls.waits, 1U);
        passes += now.betweenPasses ? 1 : 0;
        ahead += now.betweenPasses ? calls.submits - calls.waits : 0;
        return true;
    });
    EXPECT_GE(passes, 32U);
    EXPECT_GE(ahead, passes - 2) << "all but the first, whose length nobody knows, and the last before a page is folded";
}

INSTANTIATE_TEST_SUITE_P(Schedules, PassCostTest, testing::Values(Schedule::Wavefront, Schedule::Persistent),
                         [](const testing::TestParamInfo<Schedule>& schedule) { return std::string(getName(schedule.param)); });

// What the page of a picture without samples costs the device: it ends the blocks, and moves the pages to the host. It does not wait for
// the host to fold them.
TEST(FoldCostTest, IsTwoWaitsAndOneCopyOfATile)
{
    const VulkanInstance instance;
    for (const std::optional<DeviceClass> as : {std::optional<DeviceClass>(), std::optional(DeviceClass::DiscreteGpu)}) {
        Device device(instance, std::nullopt, VK_NULL_HANDLE, as);
        const Scene scene = mixedScene();
        const FlatScene flat = flattened(scene);
        RenderSettings settings = squareSettings(32, 1);
        settings.tilePixels = 32 * 16;
        RenderResources resources(device, flat, flattenCamera(scene.cameras.front(), 1.0F), settings);
        FilmAccumulator films(resources, settings, emptyFilm(settings), std::nullopt);
        films.fold();
        const VulkanCalls before = vulkanCalls();
        films.fold();
        const VulkanCalls cost = vulkanCalls() - before;
        EXPECT_EQ(cost.objects, 0U);
        EXPECT_EQ(cost.waits, 2U * 2);
        EXPECT_EQ(cost.copies, 2U + (as ? 4 * cost.submits : 0)) << "and, of a device with memory of its own, the four small buffers";
    }
}

// A GPU with 256 MiB of its memory in view of the host, and one that shares all memory, as drivers list their types.
TEST(KernelMemoryTest, IsTheDevicesOwnAndMappedOnlyIfShared)
{
    constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                                    kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                                    kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    const auto chosen = [](std::initializer_list<VkMemoryPropertyFlags> types) {
        VkPhysicalDeviceMemoryProperties memory{};
        for (const VkMemoryPropertyFlags flags : types) {
            memory.memoryTypes[memory.memoryTypeCount++].propertyFlags = flags;
        }
        const auto type = findMemoryType(memory, ~0U, kLocal, kHost | kCached);
        return type ? memory.memoryTypes[*type].propertyFlags : 0;
    };
    EXPECT_EQ(chosen({0, kLocal, kHost, kHost | kCached, kLocal | kHost}), kLocal);
    EXPECT_EQ(chosen({kLocal, kLocal | kHost, kLocal | kHost | kCached}), kLocal | kHost | kCached);
}

// What a bounce of the wavefront reads and writes of a path in device memory, at most: the sum over its three kernels. The scene comes on
// top of it.
TEST(PathBytesTest, OfABounce)
{
    constexpr std::size_t kEntry = sizeof(std::uint32_t);
    constexpr std::size_t kTrace = kEntry + sizeof(PathRay) + sizeof(PathHit);
    constexpr std::size_t kShade =
        kEntry + 2 * sizeof(PathRay) + sizeof(PathHit) + 2 * sizeof(PathState) + 2 * sizeof(PathRadiance) + sizeof(ShadowRay) + 2 * kEntry;
    constexpr std::size_t kShadow = kEntry + sizeof(ShadowRay) + 2 * sizeof(PathRadiance);
    EXPECT_EQ(kTrace, 52U);
    EXPECT_EQ(kShade, 236U);
    EXPECT_EQ(kShadow, 84U);
    EXPECT_EQ(PathBuffers::sizeInBytes(1) - PathBuffers::sizeInBytes(0), 188U) << "as host/cli/README.md says of --path-capacity";
}

}  // namespace
}  // namespace glim::test
