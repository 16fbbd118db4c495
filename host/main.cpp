// The command line in, the exit code out.
#include "host/cli/commands.hpp"
#include "host/job/outcome.hpp"
#include "host/job/version.hpp"
#include "host/message.hpp"

#include <iostream>

#include <fcntl.h>
#include <malloc.h>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

// Else a file that glim writes could get the number of a standard stream that was closed, and messages would be written into it.
void openStandardStreams()
{
    for (int stream = 0; stream < 3; ++stream) {
        if (fcntl(stream, F_GETFD) == -1) {
            open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY);  // what was closed stays unusable
        }
    }
}

}  // namespace

int main(int argc, char** argv)
{
#ifdef M_ARENA_MAX
    // glibc gives each thread an arena of its own, which keeps what was freed: with it, `glim serve` and `glim preview` grew for hours.
    // With one arena their memory stays, a first render needs 13 % less, and none is slower (tests/README.md, "For hours").
    mallopt(M_ARENA_MAX, 1);
#endif
    openStandardStreams();
    std::signal(SIGXFSZ, [](int) {});  // a file that grows too large is an error of the write
    const char* const form = std::getenv("GLIM_MESSAGES");
    const bool asJson = form != nullptr && std::string(form) == "json";
    if (asJson) {
        glim::setMessageForm(glim::MessageForm::Json);
    }
    glim::CommandLine line("glim: a path tracer in Vulkan compute kernels", glim::versionText(),
                           "`glim COMMAND --help` lists a command's options.\n"
                           "Exit codes: 0 done, 1 bad input, 2 usage, 3 device, 4 pictures differ (compare),\n"
                           "129, 130 or 143 stopped by a signal.\n"
                           "With GLIM_MESSAGES=json in the environment each message is a line of JSON with its id.");
    glim::addRender(line);
    glim::addServe(line);
    glim::addPreview(line);
    glim::addView(line);
    glim::addInspect(line);
    glim::addDevices(line);
    glim::addCompare(line);
    glim::addBench(line);
    glim::addMerge(line);
    glim::Outcome outcome = glim::runForOutcome([&] { return line.run({argv + 1, argv + argc}); });
    if (outcome.code == glim::ExitCode::Done && (!std::cout.flush() || std::ferror(stdout) != 0)) {
        outcome = {glim::ExitCode::BadInput,
                   glim::Message(glim::MessageId::FileUnwritable, {"The results could not be written to standard output."})};
    }
    if (outcome.error) {
        glim::say(glim::Severity::Error, *outcome.error);
    }
    if (outcome.code == glim::ExitCode::Usage && !asJson) {
        std::cerr << "Run with --help for more information.\n";
    }
    return static_cast<int>(outcome.code);
}
