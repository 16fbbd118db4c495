// The command line in, the exit code out.
#include "host/cli/commands.hpp"
#include "host/cli/version.hpp"
#include "host/error.hpp"
#include "host/memory.hpp"
#include "host/message.hpp"

#include <iostream>
#include <new>

namespace {

int fail(glim::ExitCode code, const std::string& sentence)
{
    glim::say(sentence.back() == '.' ? sentence : sentence + '.');
    return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv)
{
    glim::CommandLine line("glim: a path tracer in Vulkan compute kernels", glim::versionText(),
                           "`glim COMMAND --help` lists a command's options.\n"
                           "Exit codes: 0 done, 1 bad input, 2 usage, 3 device, 129, 130 or 143 stopped by a signal.");
    glim::addRender(line);
    glim::addPreview(line);
    glim::addInspect(line);
    glim::addDevices(line);
    glim::addCompare(line);
    glim::addBench(line);
    glim::addMerge(line);
    glim::ExitCode exitCode = glim::ExitCode::Done;
    try {
        exitCode = line.run({argv + 1, argv + argc});
    } catch (const glim::UsageError& error) {
        glim::say(error.what());
        std::cerr << "Run with --help for more information.\n";
        return static_cast<int>(glim::ExitCode::Usage);
    } catch (const glim::InputError& error) {
        return fail(glim::ExitCode::BadInput, error.what());
    } catch (const glim::DeviceError& error) {
        return fail(glim::ExitCode::Device, error.what());
    } catch (const std::bad_alloc&) {
        return fail(glim::ExitCode::BadInput, "For this scene and picture " + glim::memorySentence());
    }
    if (!std::cout.flush()) {
        return fail(glim::ExitCode::BadInput, "The results could not be written to standard output");
    }
    return static_cast<int>(exitCode);
}
