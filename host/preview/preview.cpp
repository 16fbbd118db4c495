#include "host/preview/preview.hpp"

#include "host/input_file.hpp"
#include "host/preview/session.hpp"

#include <exception>
#include <thread>

namespace glim {

void preview(const PreviewOptions& options)
{
    const std::vector<ScriptStep> script = options.script ? readScript(*options.script) : std::vector<ScriptStep>{};
    requireFile(options.scene, "a .gltf or a .glb file");  // before the display is missed
    EventQueue events;
    Window window("glim", options.size.value_or(glm::uvec2(512, 512)), events);
    std::exception_ptr failure;
    std::thread renderer([&] {
        try {
            Session session(window, events, options);
            session.run();
            session.printSummary();
        } catch (...) {
            failure = std::current_exception();
        }
        window.finish();
    });
    window.run(script);
    renderer.join();
    if (failure) {
        std::rethrow_exception(failure);
    }
}

}  // namespace glim
