// What does not fit into a device's memory is refused with the total, and with the option that makes textures smaller if they are much of
// it.
#include "host/render/check_memory.hpp"

#include "host/error.hpp"
#include "shaders/shared/pixel_moments.h"
#include "shaders/shared/scene_types.h"
#include "tests/support/expect_message.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20U;

void check(std::uint64_t textureBytes, std::uint64_t deviceMemory)
{
    PreparedScene prepared;
    prepared.scene.file = "a.glb";
    auto images = std::make_shared<PackedImages>();
    images->texels.resize(textureBytes / sizeof(std::uint32_t));
    prepared.flat.images = images;
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.pathCapacity = 1024;
    DeviceDescription device;
    device.name = "toy";
    device.deviceClass = DeviceClass::DiscreteGpu;
    device.memory = deviceMemory;
    device.maxGroups = 32;
    checkMemory(prepared, settings, device);
}

TEST(CheckMemoryTest, TexturesThatDoNotFitNameTheOption)
{
    check(8 * kMebibyte, 64 * kMebibyte);
    const auto refused = [](std::uint64_t textureBytes, std::uint64_t deviceMemory, const std::string& needed, bool namesOption) {
        try {
            check(textureBytes, deviceMemory);
            ADD_FAILURE() << "accepted";
        } catch (const InputError& error) {
            test::expectMessage(error.message(), MessageId::OutOfMemory, {.file = "a.glb", .place = "device \"toy\"", .value = needed});
            EXPECT_EQ(test::contains(error.what(), "8 MiB are textures, which --max-texture"), namesOption) << error.what();
        }
    };
    refused(8 * kMebibyte, 2 * kMebibyte, "8 MiB", true);
    refused(16, 1, "0 MiB", false);
}

// With g groups a path has a word and g colours, and a pixel of the device g colours and momentsOfGroups(g).
TEST(CheckMemoryTest, LightGroupsAreCounted)
{
    PreparedScene prepared;
    RenderSettings settings;
    settings.width = settings.height = 100;
    settings.pathCapacity = 1024;
    DeviceDescription device;
    device.deviceClass = DeviceClass::DiscreteGpu;
    device.maxGroups = 32;
    device.maxStorageBuffer = device.maxAllocation = std::uint64_t{1} << 27U;
    device.maxTexelElements = 1U << 27U;
    EXPECT_EQ(computeGroupBytes(prepared, settings, device, false), 0U);
    settings.lightGroups = {"a", "b", "others"};
    const std::uint64_t moments = 9 * 12, onDevice = 12 * 12 * 10000 + 1024 * 40;
    EXPECT_EQ(computeGroupBytes(prepared, settings, device, false), onDevice + 2 * moments * 10000);
    EXPECT_EQ(computeGroupBytes(prepared, settings, device, true), onDevice + 8 * moments * 10000);
    EXPECT_LE(settings.tileSize() * 144ULL, kMostOfBuffer);
    settings.lightGroups.resize(kMaxLightGroups);
    EXPECT_LE(settings.tileSize() * std::uint64_t{sumsOfGroups(kMaxLightGroups)} * 12, kMostOfBuffer);
}

}  // namespace
}  // namespace glim
