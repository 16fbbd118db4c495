// A FlatScene on the device.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/gpu/kernel.hpp"

namespace glim {

class DeviceScene {
public:
    // Throws DeviceError, saying by how much, if the scene exceeds the device.
    DeviceScene(Device& device, const FlatScene& scene);

    // The binding slots of scene.glsl.
    static std::vector<BindingSlot> slots();
    // The buffers for all these slots.
    std::map<std::uint32_t, const Buffer*> buffers() const;

private:
    Buffer nodes_, records_, triangles_, vertices_, materials_, lights_, lightNodes_, albedos_, environment_, environmentCells_;
    Buffer caustics_, instances_;
    std::vector<Buffer> images_;  // 2^kTexelViewBits texels each
};

}  // namespace glim
