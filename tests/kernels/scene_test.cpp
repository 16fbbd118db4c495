#include "shaders/shared/bindings.h"
#include "shaders/shared/scene_types.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <numeric>

namespace glim {
namespace {

// Where each field stands on the host, in words: scene_test.comp finds word k of texel t to be the float 4 t + k.
#define EXPECT_WORD(type, field, word) EXPECT_EQ(offsetof(type, field), 4U * (word)) << #type "::" #field

TEST(SceneTest, FieldsStandWhereTheDeviceReadsThem)
{
    EXPECT_WORD(FlatMaterial, baseColor, 0);
    EXPECT_WORD(FlatMaterial, scattering, 3);
    EXPECT_WORD(FlatMaterial, emission, 4);
    EXPECT_WORD(FlatMaterial, ior, 7);
    EXPECT_WORD(FlatMaterial, doubleSided, 8);
    EXPECT_WORD(FlatLight, kind, 0);
    EXPECT_WORD(FlatLight, firstEmitter, 1);
    EXPECT_WORD(FlatLight, emitterCount, 2);
    EXPECT_WORD(FlatLight, probability, 3);
    EXPECT_WORD(FlatLight, position, 4);
    EXPECT_WORD(FlatLight, radius, 7);
    EXPECT_WORD(FlatLight, direction, 8);
    EXPECT_WORD(FlatLight, cosInner, 11);
    EXPECT_WORD(FlatLight, intensity, 12);
    EXPECT_WORD(FlatLight, cosOuter, 15);
    EXPECT_WORD(FlatLight, alias.threshold, 16);
    EXPECT_WORD(FlatLight, alias.other, 17);
    EXPECT_WORD(FlatLight, doubleSided, 18);
    EXPECT_WORD(FlatEmitter, alias.threshold, 0);
    EXPECT_WORD(FlatEmitter, alias.other, 1);
    EXPECT_WORD(FlatEmitter, record, 2);
    EXPECT_WORD(FlatEmitter, light, 3);
    EXPECT_WORD(FlatEmitter, areaPdf, 4);

    std::vector<float> numbers(4096);
    std::iota(numbers.begin(), numbers.end(), 0.0F);
    Buffer texels(testDevice(), "numbers", BufferKind::Texel, numbers.size() * sizeof(float));
    upload(texels, std::span<const float>(numbers));
    std::map<std::uint32_t, const Buffer*> buffers;
    for (const std::uint32_t binding : {kBindRecords, kBindMaterials, kBindLights, kBindEmitters}) {
        buffers[binding] = &texels;
    }
    KernelTest(test_kernels::scene_test).buffers(buffers).threads(64).run();
}

}  // namespace
}  // namespace glim
