#include "host/cli/commands.hpp"
#include "host/cli/replay.hpp"
#include "host/job/render_sequence.hpp"

#include <iostream>
#include <memory>

namespace glim {

void addRender(CommandLine& line)
{
    auto options = std::make_shared<RenderJob>();
    Command& command = line.addCommand("render", "Render a glTF scene to an EXR file");
    addJobOptions(command, *options);
    command.setFooter(
        "EXR layers: R, G, B, A, albedo, normal, depth.Z, count.X, variance, error, and more for `glim merge`.\n"
        "The same scene, seed and options give the same pixels. Ctrl-C writes what is finished.\n"
        "Exit codes: 0 done, 1 bad input, 2 usage, 3 device, 129, 130 or 143 stopped by SIGHUP, SIGINT or SIGTERM.\n"
        "host/cli/README.md has more on every option.");
    command.onRun([options] {
        if (options->replay) {
            runReplay(*options);
            return ExitCode::Done;
        }
        return RenderSession(std::cout, SceneUse::Once).render(*options);
    });
}

}  // namespace glim
