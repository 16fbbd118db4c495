// What the ray through the centre of each pixel meets first: layers for those who compute with pictures. They are of one point of the
// pixel, never a mean over it.
//
// position.X .Y .Z      world coordinates, metres; NaN where the ray meets nothing
// uv.U .V               texture coordinates of the first set that the material uses; NaN where there are none
// distance.Y            from the camera along the ray, metres; infinite where it meets nothing
// instance.X            number among the scene's instances (scene_instances.hpp); kNoIndex where the ray meets nothing
// forwardFlow.X .Y      of the flow's second moment: where the same point of the surface is then, less where it is now, in pixels, right
// backwardFlow.X .Y     and down. What is infinitely far moves by its direction. NaN where no film shows it then, as behind the camera
//
// A surface with alpha is met by chance, as by the first sample of the picture. A lens counts as a pinhole.
#pragma once

#include "host/image/image.hpp"
#include "host/render/camera_rays.hpp"
#include "host/render/describe_primitive.hpp"
#include "host/render/renderer.hpp"
#include "host/render/scene_instances.hpp"

#include <filesystem>
#include <map>
#include <memory>

namespace glim {

// Of the same file as the picture's scene, at another time.
struct OtherMoment {
    Scene scene;
    FlatCamera camera;
};

struct Flow {
    OtherMoment after, before;
};

struct MetInstances {
    std::uint32_t first = kNoIndex;  // what is seen
    std::vector<std::uint32_t> all;  // ascending, as if the ray passed everything
};

class SurfaceTracer {
public:
    // `renderer` has rendered the scene; it must be idle while surfaces are traced. `kernels`: as of CameraRays. What is referred to must
    // outlive this.
    SurfaceTracer(const Renderer& renderer, const PreparedScene& prepared, const FlatCamera& camera, const SceneInstances& instances,
                  const Flow* flow = nullptr, std::shared_ptr<const CameraRayKernels> kernels = nullptr);

    std::shared_ptr<const CameraRayKernels> kernels() const { return rays_.kernels(); }

    // Rows [first, first + count) of a picture of this width.
    Image rows(std::uint32_t width, std::uint32_t first, std::uint32_t count);
    // What each pixel's ray meets. Surfaces that are less than 1e-5 of their distance behind another may be left out.
    std::vector<MetInstances> meetAll(std::span<const std::uint32_t> pixels);

    // How many pixels a trace may have.
    std::uint32_t rayCount() const { return rays_.rayCount(); }

private:
    struct Meeting;
    // Where an object of the picture's scene is at another time; kNoIndex where it is not there.
    struct Moment {
        const OtherMoment& other;
        std::vector<std::uint32_t> objects;
    };

    const std::vector<std::uint32_t>& trianglesOf(std::uint32_t object);
    Meeting meet(const PathRay& ray, const PathHit& hit);
    glm::dvec2 uvOf(const Meeting& meeting) const;
    glm::dvec2 flowTo(const Moment& moment, const Meeting& meeting, const PathRay& ray, const glm::dvec2& center) const;

    const PreparedScene& prepared_;
    const SceneInstances& instances_;
    glm::dvec2 size_;  // of the picture
    std::vector<Moment> moments_;
    CameraRays rays_;
    std::map<std::uint32_t, std::vector<std::uint32_t>> triangles_;  // of objects so far: the mesh's triangle of each of Primitives
};

// `film`: the picture's, for its size and windows.
void writeSurfaces(const std::filesystem::path& path, SurfaceTracer& tracer, const Film& film);

}  // namespace glim
