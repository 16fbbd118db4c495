// What does not fit into a device's memory is refused with the total, and with the option that makes textures smaller if they are much of
// it.
#include "host/render/check_memory.hpp"

#include "host/error.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20U;

std::string refusalOf(std::uint64_t textureBytes, std::uint64_t deviceMemory, std::uint32_t pathCapacity = 1024)
{
    PreparedScene prepared;
    prepared.scene.file = "a.glb";
    auto images = std::make_shared<PackedImages>();
    images->texels.resize(textureBytes / sizeof(std::uint32_t));
    prepared.flat.images = images;
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.pathCapacity = pathCapacity;
    DeviceDescription device;
    device.name = "toy";
    device.software = false;
    device.memory = deviceMemory;
    device.maxGroups = 32;
    try {
        checkMemory(prepared, settings, device);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(CheckMemoryTest, TexturesThatDoNotFitNameTheOption)
{
    EXPECT_EQ(refusalOf(8 * kMebibyte, 64 * kMebibyte), "");
    const std::string much = refusalOf(8 * kMebibyte, 2 * kMebibyte);
    EXPECT_EQ(much.rfind("a.glb: the scene and a picture of 16x16 need 8 MiB, which is 6 MiB more memory than device \"toy\" has; ", 0), 0U)
        << much;
    EXPECT_NE(much.find("8 MiB are textures, which --max-texture N scales down."), std::string::npos) << much;
    const std::string little = refusalOf(16, 1);
    EXPECT_NE(little.find("more memory than device \"toy\" has."), std::string::npos) << little;
}

TEST(CheckMemoryTest, PathsBeyondADispatchAreRefused)
{
    EXPECT_EQ(refusalOf(16, 64 * kMebibyte, 2048), "");
    EXPECT_EQ(refusalOf(16, 64 * kMebibyte, 2049), "Device \"toy\" starts at most 2048 paths at once, expected 2049 (--path-capacity).");
}

}  // namespace
}  // namespace glim
