// Devices with small limits and without a clock: they give the same bits, by smaller views and smaller passes, or refuse in one sentence.
// The calls below stand before those of the Vulkan library and lower what it says of the device at hand.
#include "shaders/shared/limits.h"
#include "host/gpu/kernel.hpp"
#include "host/render/pass_size.hpp"
#include "host/render/prepare_scene.hpp"
#include "shaders/shared/bindings.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <dlfcn.h>

namespace {

struct LoweredLimits {
    std::function<void(VkPhysicalDeviceLimits&)> limits = [](VkPhysicalDeviceLimits&) {};
    bool hasClock = true;
};

LoweredLimits* loweredLimits = nullptr;

template <class Function>
Function beyond(const char* name)
{
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

void vkGetPhysicalDeviceProperties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2* properties)
{
    static const auto next = beyond<PFN_vkGetPhysicalDeviceProperties2>("vkGetPhysicalDeviceProperties2");
    next(device, properties);
    if (loweredLimits != nullptr) {
        loweredLimits->limits(properties->properties.limits);
    }
}

void vkGetPhysicalDeviceQueueFamilyProperties(VkPhysicalDevice device, uint32_t* count, VkQueueFamilyProperties* families)
{
    static const auto next = beyond<PFN_vkGetPhysicalDeviceQueueFamilyProperties>("vkGetPhysicalDeviceQueueFamilyProperties");
    next(device, count, families);
    for (uint32_t i = 0; families != nullptr && loweredLimits != nullptr && !loweredLimits->hasClock && i < *count; ++i) {
        families[i].timestampValidBits = 0;
    }
}

}  // extern "C"

namespace glim {
namespace {

class LimitsTest : public testing::Test {
protected:
    LimitsTest()
    {
        testDevice();  // with its own limits
        loweredLimits = &lowered_;
    }
    ~LimitsTest() override { loweredLimits = nullptr; }

    Device& device()
    {
        if (!device_) {
            device_.emplace(instance_);
        }
        return *device_;
    }
    static Film render(Device& on, const FlatScene& flat, const Camera& camera, const RenderSettings& settings)
    {
        Renderer renderer(on, flat, flattenCamera(camera, 1.0F), settings);
        return renderer.render([](const RenderProgress&) { return true; });
    }
    // By both schedules, as on the device at hand.
    void expectTheSameBits(const FlatScene& flat, const Camera& camera, RenderSettings settings)
    {
        for (const Schedule schedule : {Schedule::Wavefront, Schedule::Persistent}) {
            settings.schedule = schedule;
            EXPECT_TRUE(sameBits(render(device(), flat, camera, settings), render(testDevice(), flat, camera, settings)))
                << getName(schedule);
        }
    }

    LoweredLimits lowered_;
    VulkanInstance instance_;
    std::optional<Device> device_;
};

// The least that Vulkan lets a device have, where glim needs no more (Vulkan 1.2, "Required Limits").
void lowerToRequired(VkPhysicalDeviceLimits& limits)
{
    limits.maxTexelBufferElements = 65536;
    limits.maxStorageBufferRange = 1U << 27U;
    limits.maxPushConstantsSize = 128;
    limits.maxMemoryAllocationCount = 4096;
    limits.maxPerStageResources = 128;
    limits.maxComputeWorkGroupCount[0] = 65535;
    limits.maxComputeWorkGroupInvocations = 128;
}

TEST_F(LimitsTest, TheLeastThatVulkanRequiresGivesTheSameBits)
{
    lowered_.limits = lowerToRequired;
    lowered_.hasClock = false;
    const Scene scene = mixedScene();
    expectTheSameBits(flattened(scene), scene.cameras.front(), squareSettings(32, 64));
    EXPECT_EQ(device().description().maxTexelElements, 65536U);
    EXPECT_LE(choosePathCapacity({}, device().description()), 65536U / 3);
}

// Of an image of 2,304 texels that lies in two views.
TEST_F(LimitsTest, TexturesInSmallViewsGiveTheSameBits)
{
    constexpr std::uint32_t kView = 1U << 13U, kBefore = kView - 1000;
    lowered_.limits = [](VkPhysicalDeviceLimits& limits) { limits.maxTexelBufferElements = kView; };
    const PreparedScene prepared = prepareScene(std::filesystem::path(GLIM_SOURCE_DIR) / "scenes/normal_map.gltf", {});
    FlatScene moved = prepared.flat;
    auto images = std::make_shared<PackedImages>(*moved.images);
    images->texels.insert(images->texels.begin(), kBefore, 0xffffffffU);
    moved.images = images;
    for (TextureData& texture : moved.textures) {
        texture.firstTexel += kBefore;
    }
    const Camera& camera = prepared.scene.cameras.front();
    const RenderSettings settings = squareSettings(16, 16);
    expectTheSameBits(moved, camera, settings);
    EXPECT_TRUE(sameBits(render(device(), moved, camera, settings), render(testDevice(), prepared.flat, camera, settings)));
}

TEST_F(LimitsTest, MoreTexelsThanAllViewsHoldAreRefused)
{
    lowered_.limits = [](VkPhysicalDeviceLimits& limits) { limits.maxTexelBufferElements = 1U << 14U; };
    const Scene scene = mixedScene();
    FlatScene flat = flattened(scene);
    auto images = std::make_shared<PackedImages>();
    images->texels.resize((kMaxTexelViews << 14U) + 1);
    flat.images = images;
    test::expectRefusal<DeviceError>([&] { render(device(), flat, scene.cameras.front(), squareSettings(8, 1)); }, MessageId::DeviceLimit,
                                     {.place = "scene's textures", .value = "131073", .expected = "131072"});
}

TEST_F(LimitsTest, TooManyAllocationsAreRefused)
{
    lowered_.limits = [](VkPhysicalDeviceLimits& limits) { limits.maxMemoryAllocationCount = 70; };
    std::vector<Buffer> buffers;
    const auto add = [&] { buffers.emplace_back(device(), "test's bytes", BufferKind::Storage, 16); };
    for (int i = 0; i < 6; ++i) {
        add();
    }
    test::expectRefusal<DeviceError>(add, MessageId::DeviceLimit, {.place = "test's bytes", .expected = "70"});
    buffers.pop_back();
    add();
}

TEST_F(LimitsTest, KernelsWithTooManyBuffersAreRefused)
{
    const auto layout = [this] { KernelLayout(device(), kernelSlots(), 0); };
    const auto used = static_cast<std::uint32_t>(KernelLayout(testDevice(), kernelSlots(), 0).bindings().size());
    const auto refused = [&](auto&& lower, const std::string& what, std::uint32_t allowed) {
        device_.reset();
        lowered_.limits = lower;
        test::expectRefusal<DeviceError>(layout, MessageId::DeviceLimit, {.place = what, .expected = std::to_string(allowed)});
    };
    refused([=](VkPhysicalDeviceLimits& limits) { limits.maxPerStageResources = used - 1; }, "buffers and images", used - 1);
    refused([](VkPhysicalDeviceLimits& limits) { limits.maxPerStageDescriptorStorageBuffers = 4; }, "storage buffers", 4);
    refused([](VkPhysicalDeviceLimits& limits) { limits.maxDescriptorSetStorageBuffers = 8; }, "storage buffers", 8);
    refused([](VkPhysicalDeviceLimits& limits) { limits.maxPerStageDescriptorSampledImages = 16; }, "texel buffers", 16);
    refused([](VkPhysicalDeviceLimits& limits) { limits.maxDescriptorSetSampledImages = 17; }, "texel buffers", 17);
    device_.reset();
    lowered_.limits = [=](VkPhysicalDeviceLimits& limits) { limits.maxPerStageResources = used; };
    layout();
}

// By the host's clock.
TEST_F(LimitsTest, PassesLearnWithoutADevicesClock)
{
    lowered_.hasClock = false;
    const Scene scene = mixedScene();
    const FlatScene flat = flattened(scene);
    RenderSettings settings = squareSettings(64, 64);
    settings.schedule = Schedule::Wavefront;
    Renderer renderer(device(), flat, flattenCamera(scene.cameras.front(), 1.0F), settings);
    renderer.render([](const RenderProgress&) { return true; });
    EXPECT_GT(renderer.statistics().passSeconds, 0.0);
    EXPECT_LT(renderer.statistics().passSeconds, renderer.statistics().renderSeconds);
    EXPECT_GT(renderer.statistics().longestDispatch, 0.0);
    EXPECT_TRUE(renderer.statistics().kernels.empty()) << "no time of a kernel is known";
}

}  // namespace
}  // namespace glim
