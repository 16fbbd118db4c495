// A scene on the test device, with the tables that lead from what kernels say back to it.
#pragma once

#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/device_scene.hpp"
#include "shaders/shared/bindings.h"
#include "tests/support/kernel_test.hpp"

namespace glim {

struct SceneOnDevice {
    explicit SceneOnDevice(const Scene& scene, const Camera& view = {})
        : bvh(buildSceneBvh(scene)), flat(flattenScene(scene, bvh)),
          device(testDevice(), flat), camera(testDevice(), flattenCamera(view, 1.0F)), recordOf(scene.triangles.size() + scene.spheres.size())
    {
        for (std::uint32_t record = 0; record < bvh.order.size(); ++record) {
            recordOf[bvh.order[record]] = record;
        }
    }

    // The primitive (triangles, then spheres) that stands at a record; kNoPrimitive for none.
    std::uint32_t idOf(std::uint32_t record) const { return record == kNoRecord ? kNoPrimitive : bvh.order[record]; }

    // `kernel` over this scene; the number of lights travels in its pass.
    KernelTest test(const EmbeddedShader& kernel) const
    {
        KernelTest test(kernel);
        test.buffers(device.buffers());
        test.buffers({{kBindCamera, &camera.buffer()}});
        test.specialize(kSpecStackLevels, flat.features.stackLevels);
        test.pass().lightCount = static_cast<std::uint32_t>(flat.lights.size());
        return test;
    }

    WideBvh bvh;
    FlatScene flat;
    DeviceScene device;
    DeviceCamera camera;
    std::vector<std::uint32_t> recordOf;  // by primitive: one of its records
};

}  // namespace glim
