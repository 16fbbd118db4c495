// Which nodes, meshes and materials of the file each pixel of a film shows: layers of indices, and mattes by name.
//
// node.X, mesh.X, material.X   index in the file of what covers most of the pixel; kNoIndex where that is nothing, or nothing of the
//                              file (the default material, the mesh of a sphere)
// CryptoObject, CryptoAsset, CryptoMaterial   of nodes, meshes and materials (host/image/cryptomatte.hpp). Without a name they are called
//                              node.N, mesh.N or material.N by their index, mesh.sphere or material.default
//
// Meshes use CryptoAsset, since nodes share a mesh as objects share an asset, and since Blender reads only these three layers.
#pragma once

#include "host/image/image.hpp"
#include "host/render/camera_rays.hpp"
#include "host/render/prepare_scene.hpp"
#include "host/render/renderer.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <string>

namespace glim {

// How many samples of a pixel show something.
struct Share {
    std::uint32_t id, samples;
};

class Identifier {
public:
    // `renderer` has rendered the scene; it must be idle while pixels are identified.
    // `kernels`: as of CameraRays.
    Identifier(const Renderer& renderer, const PreparedScene& prepared, const FlatCamera& camera,
               std::shared_ptr<const CameraRayKernels> kernels = nullptr);

    std::shared_ptr<const CameraRayKernels> kernels() const { return rays_.kernels(); }

    // The size of the film's picture, the attributes and, without values, the channels.
    Image frame(const Film& film) const;
    // Rows [first, first + count) of the film's picture. A pixel with n samples is identified by its first n, which in a film of uniform
    // sampling are its own.
    Image rows(const Film& film, std::uint32_t first, std::uint32_t count);

private:
    static constexpr std::size_t kKinds = 3;

    // Of an instance or a sphere, by kind: nodes, meshes, materials.
    struct Identity {
        std::array<std::uint32_t, kKinds> indices, mattes;
    };
    struct Planes;

    void addObject(const std::array<std::uint32_t, kKinds>& indices);
    std::string getName(std::size_t kind, std::uint32_t index) const;
    std::vector<std::vector<Share>> meet(const Film& film, std::span<const std::uint32_t> pixels);
    void write(std::size_t pixel, std::vector<Share> objects, std::uint32_t samples, Planes& planes) const;

    const PreparedScene& prepared_;
    CameraRays rays_;
    std::vector<Identity> objects_;  // the scene's instances, then its spheres
    std::array<std::map<std::string, std::uint32_t>, kKinds> manifests_;
};

void writeIds(const std::filesystem::path& path, Identifier& identifier, const Film& film);

}  // namespace glim
