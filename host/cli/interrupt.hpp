// SIGINT, SIGTERM and SIGHUP as a question to ask between passes.
#pragma once

#include "host/error.hpp"

#include <string>

namespace glim {

// While one lives, the first of these signals is only remembered; a second one ends the program as usual. A reader that goes
// away (SIGPIPE) ends nothing.
class InterruptWatch {
public:
    InterruptWatch();
    ~InterruptWatch();
    InterruptWatch(const InterruptWatch&) = delete;
    InterruptWatch& operator=(const InterruptWatch&) = delete;

    int signal() const;  // 0: none yet
};

const char* nameOfSignal(int signal);
// The exit code of work that `signal` may have ended (0: has not); says so, and `what` became of it, to stderr.
ExitCode finish(int signal, const std::string& what);

}  // namespace glim
