// A scene on the test device, with tables that lead from a kernel's records back to the scene's primitives.
#pragma once

#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/device_scene.hpp"
#include "shaders/shared/bindings.h"
#include "tests/support/kernel_test.hpp"

#include <algorithm>

namespace glim {

struct SceneOnDevice {
    explicit SceneOnDevice(const Scene& scene, const Camera& view = {})
        : SceneOnDevice(scene, makePrimitives(scene), view)
    {}

    // With primitives that are not made from the scene: triangles of zero area among them, which makePrimitives leaves out.
    SceneOnDevice(const Scene& scene, Primitives made, const Camera& view = {})
        : primitives(std::move(made)),
          bvh(buildSceneBvh(primitives)),
          flat(flattenScene(scene, primitives, bvh)),
          device(testDevice(), flat),
          camera(flattenCamera(view, 1.0F)),
          recordOf(primitives.count())
    {
        for (std::uint32_t record = 0; record < bvh.order.size(); ++record) {
            recordOf.resize(std::max<std::size_t>(recordOf.size(), bvh.order[record] + 1));  // shared meshes come after the primitives
            recordOf[bvh.order[record]] = record;
        }
    }

    // The primitive that stands at a record; kNoPrimitive for none.
    std::uint32_t idOf(std::uint32_t record) const { return record == kNoRecord ? kNoPrimitive : bvh.order[record]; }

    // `kernel` over this scene, compiled for what the scene needs; camera and number of lights are in its parameters.
    KernelTest test(const EmbeddedShader& kernel) const
    {
        KernelTest test(kernel);
        test.buffers(device.buffers());
        test.parameters().camera = camera;
        test.specialize(kSpecStackLevels, flat.stackLevels).features(flat.features).specialize(kSpecTexelViews, 1);
        test.parameters().triangleCount = flat.triangleCount;
        test.parameters().instanceCount = static_cast<std::uint32_t>(flat.instances.size() / kInstanceTexels);
        test.parameters().firstInstanceRecord = flat.firstInstanceRecord;
        test.parameters().lightCount = static_cast<std::uint32_t>(flat.lights.size());
        test.parameters().finiteLights = flat.finiteLights;
        test.parameters().infiniteImportance = flat.infiniteImportance;
        return test;
    }

    Primitives primitives;
    WideBvh bvh;
    FlatScene flat;
    DeviceScene device;
    FlatCamera camera;
    std::vector<std::uint32_t> recordOf;  // by primitive: one of its records
};

}  // namespace glim
