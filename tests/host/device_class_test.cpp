// What a device's class changes: the schedule, and how many paths are in flight.
#include "host/gpu/device_class.hpp"

#include "host/render/path_buffers.hpp"
#include "shaders/shared/limits.h"

#include <gtest/gtest.h>

namespace glim {
namespace {

TEST(DeviceClassTest, FollowsFromTypeAndDriver)
{
    const auto of = [](VkPhysicalDeviceType type, VkDriverId driver) { return classify(type, driver); };
    EXPECT_EQ(of(VK_PHYSICAL_DEVICE_TYPE_CPU, VK_DRIVER_ID_MESA_LLVMPIPE), DeviceClass::Llvmpipe);
    EXPECT_EQ(of(VK_PHYSICAL_DEVICE_TYPE_CPU, VK_DRIVER_ID_GOOGLE_SWIFTSHADER), DeviceClass::Software);
    EXPECT_EQ(of(VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, VK_DRIVER_ID_NVIDIA_PROPRIETARY), DeviceClass::DiscreteGpu);
    EXPECT_EQ(of(VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU, VK_DRIVER_ID_MESA_RADV), DeviceClass::SharedGpu);
    EXPECT_EQ(of(VK_PHYSICAL_DEVICE_TYPE_OTHER, VK_DRIVER_ID_MESA_RADV), DeviceClass::SharedGpu);
}

TEST(DeviceClassTest, OnlyOnLlvmpipeOneKernelIsFaster)
{
    EXPECT_TRUE(rulesOf(DeviceClass::Llvmpipe).persistent);
    for (const DeviceClass other : {DeviceClass::Software, DeviceClass::SharedGpu, DeviceClass::DiscreteGpu}) {
        EXPECT_FALSE(rulesOf(other).persistent);
    }
}

DeviceDescription roomy(DeviceClass deviceClass)
{
    DeviceDescription device;
    device.deviceClass = deviceClass;
    device.memory = std::uint64_t{80} << 30U;
    device.maxStorageBuffer = device.maxAllocation = std::uint64_t{4} << 30U;
    device.maxTexelElements = std::uint64_t{1} << 27U;
    device.maxGroups = 0x7fffffffU;
    return device;
}

TEST(PathCapacityChoiceTest, IsThatOfTheClass)
{
    const auto of = [](DeviceClass deviceClass) { return choosePathCapacity({}, roomy(deviceClass)); };
    EXPECT_EQ(of(DeviceClass::Llvmpipe), 1U << 18U);
    EXPECT_EQ(of(DeviceClass::Software), 1U << 18U);
    EXPECT_EQ(of(DeviceClass::SharedGpu), 1U << 20U);
    EXPECT_EQ(of(DeviceClass::DiscreteGpu), 1U << 24U);
}

// Each bound alone, with a power of two of paths.
TEST(PathCapacityChoiceTest, IsBoundedByWhatTheDeviceHas)
{
    const auto chosen = [](auto&& change) {
        DeviceDescription device = roomy(DeviceClass::DiscreteGpu);
        change(device);
        const std::uint32_t paths = choosePathCapacity({}, device);
        EXPECT_LE(PathBuffers::sizeInBytes(paths), std::max(device.memory / 10, PathBuffers::sizeInBytes(kBlockSamples)));
        return paths;
    };
    const auto ofMemory = [&](std::uint64_t mebibytes) { return chosen([&](DeviceDescription& d) { d.memory = mebibytes << 20U; }); };
    EXPECT_EQ(ofMemory(16376), 1U << 23U) << "a card of 16 GiB";
    EXPECT_EQ(ofMemory(12288), 1U << 22U);
    EXPECT_EQ(ofMemory(8192), 1U << 22U);
    EXPECT_EQ(ofMemory(4096), 1U << 21U);
    EXPECT_EQ(chosen([](DeviceDescription& d) { d.maxStorageBuffer = 128U << 20U; }), 1U << 21U);
    EXPECT_EQ(chosen([](DeviceDescription& d) { d.maxAllocation = 128U << 20U; }), 1U << 21U);
    EXPECT_EQ(chosen([](DeviceDescription& d) { d.maxTexelElements = 65536; }), 1U << 14U);
    EXPECT_EQ(chosen([](DeviceDescription& d) { d.maxGroups = 65535; }), 1U << 21U);
    EXPECT_EQ(chosen([](DeviceDescription& d) { d.memory = 1; }), kBlockSamples);
}

TEST(PathCapacityChoiceTest, IsWhatIsAskedForAsFarAsTheDeviceAllows)
{
    RenderSettings settings;
    settings.pathCapacity = 12345;
    DeviceDescription device = roomy(DeviceClass::DiscreteGpu);
    EXPECT_EQ(choosePathCapacity(settings, device), 12345U);
    device.memory = 1;
    EXPECT_EQ(choosePathCapacity(settings, device), 12345U);
    device.maxGroups = 100;
    EXPECT_EQ(choosePathCapacity(settings, device), 96 * settings.workgroup) << "queues ask for eight workgroups at once";
    settings.pathCapacity = 1U << 20U;
    device = roomy(DeviceClass::Software);
    device.maxTexelElements = 65536;
    EXPECT_EQ(choosePathCapacity(settings, device), 65536 / 3);  // the longest of a path in one buffer is three texels
}

}  // namespace
}  // namespace glim
