// A FlatScene on the device.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/gpu/kernel.hpp"

namespace glim {

// The texels of images that a buffer holds on this device are 2 to this power.
std::uint32_t texelViewBits(const DeviceDescription& device);

// The images and the environment map of a scene, on the device.
class DeviceTextures {
public:
    DeviceTextures(Device& device, const FlatScene& scene);

    // Whether they are those of `scene`.
    bool serve(const FlatScene& scene) const { return images_ == scene.images && environmentMap_ == scene.environmentMap; }
    void addTo(std::map<std::uint32_t, const Buffer*>& buffers) const;

private:
    std::shared_ptr<const PackedImages> images_;
    std::shared_ptr<const PackedEnvironment> environmentMap_;
    std::vector<Buffer> imageViews_;  // of texelViewBits
    Buffer environment_, environmentCells_;
};

// An array of a scene, on the device.
struct DeviceArray {
    SharedVector<uvec4>::Identity source;
    std::shared_ptr<const Buffer> buffer;
};

// What the next scene may have in common with this one.
struct LastingBuffers {
    std::shared_ptr<const DeviceTextures> textures;
    DeviceArray nodes, primitiveRefs, triangles, vertices, instances, motions;
};

class DeviceScene {
public:
    // Uses what serves the scene of `lasting`. Throws DeviceError, saying by how much, if the scene exceeds the device.
    DeviceScene(Device& device, const FlatScene& scene, LastingBuffers lasting = {});

    // The binding slots of scene.glsl.
    static std::vector<BindingSlot> slots();
    // The buffers for all these slots.
    std::map<std::uint32_t, const Buffer*> buffers() const;
    const LastingBuffers& lasting() const { return lasting_; }

private:
    LastingBuffers lasting_;
    Buffer materials_, lights_, lightNodes_, albedos_, caustics_;
};

}  // namespace glim
