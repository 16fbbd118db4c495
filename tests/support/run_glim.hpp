// The built program as a user runs it: a process with arguments, an environment and a working folder.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace glim::test {

struct GlimCall {
    std::vector<std::string> arguments;
    std::map<std::string, std::optional<std::string>> environment;  // on top of the test's own; nothing: unset
    std::filesystem::path folder = std::filesystem::current_path();
    std::filesystem::path program = GLIM_BINARY;
    int signalAtFirstLine = 0;  // sent once stderr has a whole line
};

struct GlimRun {
    int exitCode = -1;  // -1: ended by a signal
    int signal = 0;     // that ended it
    std::string out, err;
};

// Adds a failure to the running test, and ends the process, if it takes longer than two minutes.
GlimRun runGlim(const GlimCall& call);
GlimRun runGlim(const std::vector<std::string>& arguments);

// The path of scenes/NAME.
std::string sceneFile(const std::string& name);

std::size_t countLines(const std::string& text);

}  // namespace glim::test
