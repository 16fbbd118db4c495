// SIGINT, SIGTERM and SIGHUP, to be polled between passes.
#pragma once

#include "host/error.hpp"

#include <string>

namespace glim {

// While an InterruptWatch exists, the first of these signals is only remembered; a second one ends the program as usual. A reader that
// goes away (SIGPIPE) ends nothing.
class InterruptWatch {
public:
    InterruptWatch();
    ~InterruptWatch();
    InterruptWatch(const InterruptWatch&) = delete;
    InterruptWatch& operator=(const InterruptWatch&) = delete;

    int signal() const;  // 0: none yet
};

const char* nameOfSignal(int signal);
// The exit code of work that `signal` ended (0: nothing did). If one did, prints that, and `what` became of the work, to stderr.
ExitCode finish(int signal, const std::string& what);

}  // namespace glim
