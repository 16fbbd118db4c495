// The command line in, the exit code out.
#include "host/cli/commands.hpp"
#include "host/cli/outcome.hpp"
#include "host/cli/version.hpp"
#include "host/message.hpp"

#include <iostream>

#include <malloc.h>

int main(int argc, char** argv)
{
#ifdef M_ARENA_MAX
    // glibc gives each thread an arena of its own, which keeps what was freed: with it, `glim serve` and `glim preview` grew for hours.
    // With one arena their memory stays, a first render needs 13 % less, and none is slower (tests/README.md, "For hours").
    mallopt(M_ARENA_MAX, 1);
#endif
    glim::CommandLine line("glim: a path tracer in Vulkan compute kernels", glim::versionText(),
                           "`glim COMMAND --help` lists a command's options.\n"
                           "Exit codes: 0 done, 1 bad input, 2 usage, 3 device, 129, 130 or 143 stopped by a signal.");
    glim::addRender(line);
    glim::addServe(line);
    glim::addPreview(line);
    glim::addView(line);
    glim::addInspect(line);
    glim::addDevices(line);
    glim::addCompare(line);
    glim::addBench(line);
    glim::addMerge(line);
    glim::Outcome outcome = glim::outcomeOf([&] { return line.run({argv + 1, argv + argc}); });
    if (outcome.error.empty() && !std::cout.flush()) {
        outcome = {glim::ExitCode::BadInput, "The results could not be written to standard output."};
    }
    if (!outcome.error.empty()) {
        glim::say(outcome.error);
    }
    if (outcome.code == glim::ExitCode::Usage) {
        std::cerr << "Run with --help for more information.\n";
    }
    return static_cast<int>(outcome.code);
}
