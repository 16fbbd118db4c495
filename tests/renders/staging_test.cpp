// What a discrete GPU does runs on the device at hand: the copies, since the host does not map its memory, and the rules of its class.
#include "host/flatten/flatten_scene.hpp"
#include "host/gpu/commands.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

namespace glim {
namespace {

using Bytes = std::vector<std::byte>;

// Different bytes at different places, so that a part of a copy at a wrong place is noticed.
Bytes makeBytes(std::uint64_t count, std::uint64_t seed)
{
    Random random(seed);
    Bytes bytes(count);
    std::uint32_t bits = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        bits = i % 4 == 0 ? random.bits() : bits >> 8;
        bytes[i] = static_cast<std::byte>(bits);
    }
    return bytes;
}

class StagingTest : public testing::Test {
protected:
    Buffer storage(std::uint64_t size) { return {device, "test's bytes", BufferKind::Storage, size}; }

    VulkanInstance instance;
    Device device{instance, std::nullopt, VK_NULL_HANDLE, DeviceClass::DiscreteGpu};
};

TEST_F(StagingTest, NoMemoryOfKernelsIsMapped)
{
    for (const BufferKind kind : {BufferKind::Storage, BufferKind::Texel, BufferKind::Both, BufferKind::Readback}) {
        EXPECT_FALSE(Buffer(device, "test's bytes", kind, 64).isMapped());
        EXPECT_TRUE(Buffer(testDevice(), "test's bytes", kind, 64).isMapped() || !isSoftware(testDevice().description().deviceClass));
    }
}

// Whatever is submitted, and also after the buffer has moved or another one has gone.
TEST_F(StagingTest, EachWaitCopiesReadbackBuffersToTheHost)
{
    const auto readback = [&](std::uint64_t seed) {
        Buffer buffer(device, "test's bytes", BufferKind::Readback, 64);
        buffer.upload(makeBytes(64, seed));
        return buffer;
    };
    Buffer a = readback(1);
    {
        const Buffer gone = readback(2);
        EXPECT_TRUE(download<std::byte>(gone, 64) == makeBytes(64, 2));
    }
    const Buffer b = readback(3), moved = std::move(a);
    EXPECT_TRUE(download<std::byte>(moved, 64) == makeBytes(64, 1));
    Commands commands(device);
    commands.copy(b.handle(), 0, moved.handle(), 64);
    commands.submitAndWait();
    EXPECT_TRUE(download<std::byte>(moved, 64) == makeBytes(64, 3));
}

TEST_F(StagingTest, BytesComeBack)
{
    for (const std::uint64_t size : {std::uint64_t{1}, std::uint64_t{3}, std::uint64_t{4097}, kStagingBytes - 1, kStagingBytes,
                                     kStagingBytes + 1, 2 * kStagingBytes - 4, 2 * kStagingBytes + 5}) {
        Buffer buffer = storage(size);
        const Bytes sent = makeBytes(size, size);
        buffer.upload(sent);
        EXPECT_TRUE(download<std::byte>(buffer, size) == sent) << size;
    }
}

TEST_F(StagingTest, AShortCopyLeavesTheRest)
{
    const std::uint64_t size = 2 * kStagingBytes + 64;
    Buffer buffer = storage(size);
    Bytes expected = makeBytes(size, 1);
    buffer.upload(expected);
    for (const std::uint64_t part : {std::uint64_t{0}, std::uint64_t{5}, kStagingBytes + 1}) {
        const Bytes sent = makeBytes(part, 2 + part);
        buffer.upload(sent);
        std::copy(sent.begin(), sent.end(), expected.begin());
        EXPECT_TRUE(download<std::byte>(buffer, part) == sent) << part;
        EXPECT_TRUE(download<std::byte>(buffer, size) == expected) << part;
    }
}

// Several buffers in one list of commands.
TEST_F(StagingTest, FillsAndCopies)
{
    const std::uint64_t size = kStagingBytes + 4;
    Buffer a = storage(size), b = storage(size), c = storage(size);
    const Bytes first = makeBytes(size, 1), second = makeBytes(size, 2);
    a.upload(first);
    b.upload(second);
    c.upload(second);
    Commands commands(device);
    commands.fillWithZero(c);
    commands.copy(a.handle(), 8, b.handle(), 1000);
    commands.copy(b.handle(), 0, c.handle(), 2000, size - 2000);
    commands.submitAndWait();
    Bytes middle = second, last(size);
    std::copy_n(first.begin() + 8, 1000, middle.begin());
    std::copy_n(middle.begin(), 2000, last.end() - 2000);
    EXPECT_TRUE(download<std::byte>(a, size) == first);
    EXPECT_TRUE(download<std::byte>(b, size) == middle);
    EXPECT_TRUE(download<std::byte>(c, size) == last);
}

// What tools/gpu_check reports.
TEST_F(StagingTest, CopiesInGigabytesPerSecond)
{
    using Clock = std::chrono::steady_clock;
    const Bytes sent = makeBytes(1 << 20, 3);
    const std::uint64_t size = std::uint64_t{64} << 20U;
    Bytes whole;
    for (std::uint64_t i = 0; i < size; i += sent.size()) {
        whole.insert(whole.end(), sent.begin(), sent.end());
    }
    Buffer buffer = storage(size);
    const auto rate = [&](const auto& copy) {
        copy();  // the first one also maps pages
        const Clock::time_point begin = Clock::now();
        copy();
        return 1e-9 * static_cast<double>(size) / std::chrono::duration<double>(Clock::now() - begin).count();
    };
    const double up = rate([&] { buffer.upload(whole); });
    Bytes back;
    const double down = rate([&] { back = download<std::byte>(buffer, size); });
    std::printf("upload %.3g GB/s, download %.3g GB/s\n", up, down);
    EXPECT_TRUE(back == whole);
}

// The film's pages end at 256 samples; an adaptive render also chooses pixels, which the host looks at.
TEST_F(StagingTest, ARenderHasTheBitsOfASoftwareDevice)
{
    const Scene scene = mixedScene();
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = flattenCamera(scene.cameras.front(), 1.0F);
    RenderSettings uniform = squareSettings(16, 264), adaptive = squareSettings(16, 80);
    adaptive.adaptive = Adaptive::Neighbours;
    for (RenderSettings settings : {uniform, adaptive}) {
        settings.pathCapacity = 1U << 12U;
        for (const Schedule schedule : {Schedule::Wavefront, Schedule::Persistent}) {
            settings.schedule = schedule;
            const auto render = [&](Device& on) {
                Renderer renderer(on, flat, camera, settings);
                Film film = renderer.render([](const RenderProgress&) { return true; });
                return std::pair(std::move(film), renderer.statistics().cameraAndBounceRays + renderer.statistics().shadowRays);
            };
            const auto [staged, stagedRays] = render(device);
            const auto [mapped, mappedRays] = render(testDevice());
            EXPECT_TRUE(sameBits(staged, mapped)) << getName(schedule);
            EXPECT_EQ(stagedRays, mappedRays) << getName(schedule);
        }
    }
}

// Each tile's page is folded while the device traces the next one.
TEST_F(StagingTest, PagesOfSeveralTilesHaveTheBitsOfASoftwareDevice)
{
    const Scene scene = mixedScene();
    RenderSettings settings = squareSettings(8, 2 * kPageSamples + 1);
    settings.tilePixels = 24;
    const auto render = [&](Device& on) {
        return Renderer(on, flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), settings).render([](const RenderProgress&) {
            return true;
        });
    };
    const Film film = render(device);
    settings.tilePixels = 64;
    EXPECT_TRUE(sameBits(film, render(testDevice())));
}

}  // namespace
}  // namespace glim
