#include "host/preview/preview.hpp"

#include "host/input_file.hpp"
#include "host/preview/session.hpp"
#include "host/window/run_window.hpp"

namespace glim {

void preview(const PreviewOptions& options)
{
    const std::vector<ScriptStep> script = options.script ? readScript(*options.script) : std::vector<ScriptStep>{};
    requireFile(options.scene, "a .gltf or a .glb file");  // before the display is missed
    EventQueue events;
    Window window("glim", options.window.value_or(options.size.value_or(glm::uvec2(512, 512))), events);
    runWindow(window, script, [&] {
        Session session(window, events, options);
        session.run();
        session.printSummary();
    });
}

}  // namespace glim
