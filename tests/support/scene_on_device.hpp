// A scene on the test device, with tables that lead from a kernel's references back to the scene's primitives.
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
          refOfPrimitive(primitives.count())
    {
        for (std::uint32_t ref = 0; ref < bvh.order.size(); ++ref) {
            refOfPrimitive.resize(
                std::max<std::size_t>(refOfPrimitive.size(), bvh.order[ref] + 1));  // shared meshes come after the primitives
            refOfPrimitive[bvh.order[ref]] = ref;
        }
    }

    // The primitive that stands at a reference; kNoPrimitive for none.
    std::uint32_t idOf(std::uint32_t ref) const { return ref == kNoPrimitiveRef ? kNoPrimitive : bvh.order[ref]; }

    // `kernel` over this scene, compiled for what the scene needs; camera and number of lights are in its parameters.
    KernelTest test(const EmbeddedShader& kernel) const
    {
        KernelTest test(kernel);
        test.buffers(device.buffers());
        test.parameters().camera = camera;
        test.features(flat.features).specialize(kSpecStackLevels, flat.stackLevels).specialize(kSpecTexelViews, 1);
        test.parameters().triangleCount = flat.triangleCount;
        test.parameters().instanceCount = static_cast<std::uint32_t>(flat.instances.size() / kInstanceTexels);
        test.parameters().firstInstanceRef = flat.firstInstanceRef;
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
    std::vector<std::uint32_t> refOfPrimitive;  // by primitive: one of its references
};

}  // namespace glim
