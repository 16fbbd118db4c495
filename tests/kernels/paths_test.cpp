#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim::paths_test {

constexpr std::uint32_t kSlots = 100;

template <class T, class Make>
Buffer filled(const std::string& name, Make make, BufferKind kind = BufferKind::Storage)
{
    std::vector<T> values;
    for (std::uint32_t i = 0; i < kSlots; ++i) {
        values.push_back(make(i));
    }
    Buffer buffer(testDevice(), name, kind, kSlots * sizeof(T));
    upload(buffer, std::span<const T>(values));
    return buffer;
}

template <class T>
Buffer zeroed(const std::string& name, BufferKind kind = BufferKind::Storage)
{
    return filled<T>(
        name, [](std::uint32_t) { return T{}; }, kind);
}

TEST(PathsTest, EachBufferIsAtItsBinding)
{
    const Buffer active = filled<uint>("active queue", [](uint i) { return 3000 + i; });
    const Buffer shadow = filled<uint>("shadow queue", [](uint i) { return 4000 + i; });
    const Buffer rays = filled<PathRay>(
        "rays",
        [](uint i) {
            return PathRay{vec3(0), 5000 + i, vec3(0)};
        },
        BufferKind::Both);
    const Buffer shadowRays = filled<ShadowRay>(
        "shadow rays", [](uint i) { return ShadowRay{vec3(0), 0, vec3(0), 6000 + i, vec3(0), 1.0F}; }, BufferKind::Both);
    const Buffer rounds = filled<Round>("rounds", [](uint i) {
        return i == 2 ? Round{{kSlots, uvec3(0)}, {0, uvec3(0, 0, 77)}} : Round{};
    });
    const Buffer states = filled<PathState>(
        "states",
        [](uint) {
            return PathState{vec3(1), 0.5F, 0.0F, 1.0F};
        },
        BufferKind::Both);
    const Buffer radiance = filled<PathRadiance>(
        "radiance",
        [](uint) {
            return PathRadiance{vec3(1), 0.25F};
        },
        BufferKind::Both);
    const Buffer counts = zeroed<RayCounts>("ray counts");
    const Buffer hits = filled<PathHit>(
        "hits",
        [](uint i) {
            return PathHit{8000 + i, 0.0F, vec2(0)};
        },
        BufferKind::Both);
    const Buffer firstHits = zeroed<FirstHit>("first hits", BufferKind::Both), next = zeroed<uint>("next queue");
    KernelTest test(test_kernels::paths_test);
    test.buffers({{kBindActiveQueue, &active},
                  {kBindShadowQueue, &shadow},
                  {kBindRays, &rays},
                  {kBindStates, &states},
                  {kBindShadowRays, &shadowRays},
                  {kBindRounds, &rounds},
                  {kBindRadiance, &radiance},
                  {kBindHits, &hits},
                  {kBindRayCounts, &counts},
                  {kBindFirstHits, &firstHits},
                  {kBindNextQueue, &next}});
    test.threads(kSlots).run();
    for (std::uint32_t i = 0; i < kSlots; ++i) {
        const auto f = static_cast<float>(i);
        EXPECT_EQ(download<PathState>(states, kSlots)[i].pdf, 0.5F + f);
        EXPECT_EQ(download<PathRadiance>(radiance, kSlots)[i].clamped, 0.25F + 2.0F * f);
        EXPECT_EQ(download<PathHit>(hits, kSlots)[i].t, 3.0F * f);
        EXPECT_EQ(download<FirstHit>(firstHits, kSlots)[i].depth, 4.0F * f);
        EXPECT_EQ(download<uint>(next, kSlots)[i], 7000 + i);
    }
    EXPECT_EQ(download<Round>(rounds, 2)[1].shadowRays.count, kSlots);
    EXPECT_EQ(download<Round>(rounds, 2)[1].paths.count, 0U);
    EXPECT_EQ(download<RayCounts>(counts, 1)[0].closest, uvec2(0, 2 * kSlots));
}

}  // namespace glim::paths_test
