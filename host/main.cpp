// The command line in, the exit code out.
#include "host/cli/bench.hpp"
#include "host/cli/compare.hpp"
#include "host/cli/devices.hpp"
#include "host/cli/inspect.hpp"
#include "host/cli/merge.hpp"
#include "host/cli/preview.hpp"
#include "host/cli/render.hpp"
#include "host/cli/version.hpp"
#include "host/error.hpp"

#include <CLI/CLI.hpp>

#include <iostream>
#include <new>

namespace {

int fail(glim::ExitCode code, const std::string& sentence)
{
    std::cerr << "glim: " << sentence << (sentence.back() == '.' ? "\n" : ".\n");
    return static_cast<int>(code);
}

// CLI11 would complain of what is missing even where something that it does not know explains it.
std::string usageSentence(const CLI::App* app, const CLI::Error& error)
{
    const std::vector<std::string> unknown = app->remaining(true);
    const std::string sentence =
        unknown.empty() ? error.what() : "\"" + unknown[0] + "\" was not expected: no such command, option or argument";
    return "glim: " + sentence + "\nRun with --help for more information.\n";
}

}  // namespace

int main(int argc, char** argv)
{
    glim::ExitCode exitCode = glim::ExitCode::Done;
    CLI::App app("glim: a path tracer in Vulkan compute kernels", "glim");
    app.set_version_flag("--version", glim::versionText());
    app.failure_message(usageSentence);
    app.require_subcommand(1);
    app.footer("Exit codes: 0 done, 1 bad input, 2 usage, 3 device, 129, 130 or 143 stopped by a signal.");
    glim::addRender(app, exitCode);
    glim::addPreview(app);
    glim::addInspect(app);
    glim::addDevices(app);
    glim::addCompare(app);
    glim::addBench(app, exitCode);
    glim::addMerge(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : static_cast<int>(glim::ExitCode::Usage);
    } catch (const glim::InputError& error) {
        return fail(glim::ExitCode::BadInput, error.what());
    } catch (const glim::DeviceError& error) {
        return fail(glim::ExitCode::Device, error.what());
    } catch (const std::bad_alloc&) {
        return fail(glim::ExitCode::BadInput, "There is not enough memory for this scene and picture.");
    }
    if (!std::cout.flush()) {
        return fail(glim::ExitCode::BadInput, "The results could not be written to standard output");
    }
    return static_cast<int>(exitCode);
}
