// --focus: what a pixel shows says how far away the plane in focus is.
#pragma once

#include "host/job/scene_session.hpp"
#include "host/render/camera_rays.hpp"

namespace glim {

// Keeps the kernels of one picture for the next; they must go before the session.
class FocusFinder {
public:
    // The options with the focal distance that --focus, if it is given, stands for: how far along the camera's axis the ray through the
    // pixel's centre and the middle of the lens meets a surface. The pixel is one of the whole picture, also with --crop and --rows. Says
    // the distance. The session must be posed at the picture's time. Throws InputError if the pixel shows no surface.
    RenderJob resolve(RenderJob options, SceneSession& session);

private:
    std::shared_ptr<const CameraRayKernels> kernels_;
};

}  // namespace glim
