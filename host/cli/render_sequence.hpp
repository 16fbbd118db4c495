// `glim render` and `glim serve`: one picture after another.
#pragma once

#include "host/cli/render_options.hpp"

#include <memory>

namespace glim {

class SequenceRenderer;

class RenderSession {
public:
    RenderSession();
    ~RenderSession();

    // Writes all files of all pictures, and reports on each. In a sequence, a film that is there, whole and of the same scene and settings
    // is kept. The scene, the device and the kernels serve again if the options differ from the previous ones in nothing but samples,
    // seed, size, camera, time and outputs, and if no file of the scene has changed.
    ExitCode render(const RenderOptions& options);

private:
    std::unique_ptr<SequenceRenderer> renderer_;
};

}  // namespace glim
