// The files of what a picture's pixels show: --ids, --surfaces and --objects.
#pragma once

#include "host/job/render_picture.hpp"
#include "host/render/surfaces.hpp"

#include <memory>
#include <optional>

namespace glim {

// Of the scene and the job's camera as much later and earlier as --flow says; nothing without. Throws InputError as the scene's file does.
std::optional<Flow> makeFlow(SceneSession& session, const RenderJob& job, const PictureFrame& frame);

// Writes those that are asked for, after the renderer has rendered the film. Takes from one picture to the next the kernels that it needs.
class SurfaceFiles {
public:
    // How long it took, in seconds; nothing if none is asked for.
    std::optional<double> write(SceneSession& session, const RenderJob& job, const PictureFrame& frame, const Film& film);

private:
    std::shared_ptr<const CameraRayKernels> sampleKernels_, centerKernels_;
};

}  // namespace glim
