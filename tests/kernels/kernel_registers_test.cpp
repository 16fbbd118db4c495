// Compiles kernels one after the other, those that traverse with both stacks. A driver that prints registers and spills then prints them
// behind the kernel's name (tests/bench/GPU.md).
#include "host/flatten/flatten_scene.hpp"
#include "host/render/kernel_set.hpp"
#include "host/render/path_buffers.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/course_types.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace glim::kernel_registers_test {

TEST(KernelRegistersTest, EachKernelIsCompiledAlone)
{
    const Scene scene = mixedScene();
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = flattenCamera(scene.cameras.front(), 1.0F);
    const KernelLayout layout(testDevice(), kernelSlots(), sizeof(CoursePass));
    Specialization constants = specialize(flat, camera, {}, testDevice().description());
    constants[kSpecStackLevels] = 8;  // a large scene's
    const auto compile = [&](const EmbeddedShader& shader, bool shared) {
        constants[kSpecSharedStack] = shared;
        std::cerr << "kernel " << shader.name << (shared ? ", shared stack\n" : "\n");
        EXPECT_NE(Kernel(layout, shader, constants).pipeline(), VkPipeline{});
    };
    for (const EmbeddedShader& shader : {kernels::generate_rays, kernels::shade_surface, kernels::accumulate}) {
        compile(shader, false);
    }
    for (const EmbeddedShader& shader : {kernels::trace_closest, kernels::trace_shadow, kernels::trace_light_paths, kernels::trace_paths}) {
        compile(shader, false);
        compile(shader, true);
    }
}

}  // namespace glim::kernel_registers_test
