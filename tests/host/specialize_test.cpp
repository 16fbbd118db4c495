#include "host/render/kernel_set.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/features.h"

#include <gtest/gtest.h>
#include <spirv-tools/libspirv.hpp>

namespace glim {
namespace {

const EmbeddedShader* const kKernels[] = {&kernels::accumulate,    &kernels::course_bounce, &kernels::course_sample_lights,
                                          &kernels::generate_rays, &kernels::shade_surface, &kernels::show_aov,
                                          &kernels::trace_closest, &kernels::trace_paths,   &kernels::trace_shadow};

const FeatureMask kFeatureMasks[] = {
    0,
    kFeatureTriangleLights,
    kFeatureMirror | kFeatureDielectric | kFeatureSphereLights,
    kFeaturePrincipled,
    kFeaturePrincipled | kFeatureTextures | kFeatureNormalMaps | kFeatureEnvironment | kFeatureEnvironmentMap,
    kAllFeatures};

constexpr Arithmetic kNative{.exact = false};

TEST(SpecializeTest, KernelsStayValid)
{
    spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_2);
    std::string message;
    tools.SetMessageConsumer([&message](spv_message_level_t, const char*, const spv_position_t&, const char* text) { message = text; });
    spvtools::ValidatorOptions options;
    options.SetScalarBlockLayout(true);
    for (const EmbeddedShader* kernel : kKernels) {
        for (const FeatureMask features : kFeatureMasks) {
            SCOPED_TRACE(std::string(kernel->name) + " with features " + std::to_string(features));
            for (const Arithmetic& arithmetic : {kNative, Arithmetic{.declaresRounding = true}, Arithmetic{.adverse = 1}}) {
                const std::vector<std::uint32_t> words = specialize(*kernel, makeConstants(features), arithmetic);
                EXPECT_TRUE(tools.Validate(words.data(), words.size(), options)) << message;
            }
        }
    }
}

// The size of the code decides how long drivers take to start. 2: measured 2.4.
TEST(SpecializeTest, CodeThatASceneDoesNotNeedIsGone)
{
    const auto size = [](FeatureMask features) { return specialize(kernels::trace_paths, makeConstants(features), kNative).size(); };
    EXPECT_LT(2 * size(kFeatureTriangleLights), size(kAllFeatures));
}

TEST(SpecializeTest, BrokenCodeIsRefused)
{
    const std::uint32_t words[] = {0x07230203, 0x00010500, 0, 10, 0, 0x00030000};
    const EmbeddedShader broken{"broken", words, words + 6};
    EXPECT_ANY_THROW(specialize(broken, {}, kNative));
}

}  // namespace
}  // namespace glim
