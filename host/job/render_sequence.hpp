// `glim render` and `glim serve`: one picture after another.
#pragma once

#include "host/job/render_job.hpp"
#include "host/render/prepare_scene.hpp"

#include <iosfwd>
#include <memory>

namespace glim {

class SequenceRenderer;

class RenderSession {
public:
    // What it has done goes to `reports`, a line for each film. Used once, it takes less memory.
    explicit RenderSession(std::ostream& reports, SceneUse use = SceneUse::Again);
    ~RenderSession();

    // Writes all files of all pictures, and reports on each. In a sequence, a film that is there, whole and of the same scene and settings
    // is kept. The scene, the device and the kernels serve again if the options differ from the previous ones in nothing but samples,
    // seed, size, camera, time and outputs, and if no file of the scene has changed.
    ExitCode render(const RenderJob& options);

private:
    std::ostream& reports_;
    const SceneUse use_;
    std::unique_ptr<SequenceRenderer> renderer_;
};

}  // namespace glim
