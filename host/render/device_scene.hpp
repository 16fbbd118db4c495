// A FlatScene on the device.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/gpu/kernel.hpp"

namespace glim {

class DeviceScene {
public:
    // Throws DeviceError, saying by how much, if the scene exceeds the device.
    DeviceScene(Device& device, const FlatScene& scene);

    // The slots of scene.glsl.
    static std::vector<BindingSlot> slots();
    // For all of them but the camera's.
    std::map<std::uint32_t, const Buffer*> buffers() const;

private:
    Buffer nodes_, records_, normals_, materials_, lights_, emitters_;
};

class DeviceCamera {
public:
    DeviceCamera(Device& device, const FlatCamera& camera);

    // No kernel may be running.
    void set(const FlatCamera& camera) { upload(buffer_, std::span<const FlatCamera>(&camera, 1)); }
    const Buffer& buffer() const { return buffer_; }

private:
    Buffer buffer_;
};

}  // namespace glim
