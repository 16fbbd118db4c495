#include "host/view/view.hpp"

#include "host/view/view_session.hpp"
#include "host/window/run_window.hpp"

namespace glim {
namespace {

constexpr glm::uvec2 kMinSize(640, 480);  // the panel needs about as much

}  // namespace

void view(const ViewOptions& options)
{
    const std::vector<ScriptStep> script = options.script ? readScript(*options.script) : std::vector<ScriptStep>{};
    ViewedFilms films(options.film, options.reference);  // refused before the display is missed
    const glm::uvec2 size = options.size ? *options.size : glm::min(glm::max(films.size(), kMinSize), Window::screenSize());
    EventQueue events;
    Window window("glim: " + films.title(), size, events);
    runWindow(window, script, [&] {
        ViewSession session(window, events, options, std::move(films));
        session.run();
        if (options.script) {
            session.printSummary();
        }
    });
}

}  // namespace glim
