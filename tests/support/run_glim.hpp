// The built program as a user runs it: a process with arguments, an environment and a working folder.
#pragma once

#include "places.h"

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace glim::test {

struct GlimCall {
    std::vector<std::string> arguments;
    // Added to the test's own environment; nullopt unsets a variable. The user's cache is neither read nor written; that of the tests
    // saves half of a short run's time.
    std::map<std::string, std::optional<std::string>> environment{{"GLIM_CACHE_DIR", GLIM_BUILD_DIR "/cache"}};
    std::filesystem::path folder = std::filesystem::current_path();
    std::filesystem::path program = GLIM_BINARY;
    // Sends `signal` once this is true of what stderr has so far. The program goes on meanwhile.
    std::function<bool(const std::string& err)> signalWhen;
    int signal = 0;
};

struct GlimRun {
    int exitCode = -1;  // -1: ended by a signal
    int signal = 0;     // that ended it
    std::string out, err;
};

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Whether there is a whole line.
inline bool hasLine(const std::string& err) { return err.find('\n') != std::string::npos; }

// Adds a failure to the running test, and ends the process, if it takes longer than two minutes.
GlimRun runGlim(const GlimCall& call);
GlimRun runGlim(const std::vector<std::string>& arguments);

// The same on a terminal of its own, which is standard input, output and error, and the session's: `out` has all that it showed. `watch`
// is given the terminal's other end and what it showed so far; false hangs up.
using TerminalWatch = std::function<bool(int terminal, const std::string& shown)>;
GlimRun runOnTerminal(const GlimCall& call, unsigned short columns = 80, const TerminalWatch& watch = {});

// The call by a shell, after a command that changes what glim finds ("ulimit -f 2"); `redirections` as in ">&-".
GlimCall afterCommand(const std::string& command, GlimCall call, const std::string& redirections = "");

// The path of scenes/NAME.
std::string sceneFile(const std::string& name);

std::size_t countLines(const std::string& text);

}  // namespace glim::test
