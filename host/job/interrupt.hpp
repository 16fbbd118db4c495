// SIGINT, SIGTERM, SIGHUP and SIGUSR1, to be polled between passes.
#pragma once

#include "host/error.hpp"

#include <string>

namespace glim {

// While an InterruptWatch exists, the first of the first three is only remembered; a second one ends the program as usual. SIGUSR1 asks
// for a checkpoint. A reader that goes away (SIGPIPE) ends nothing.
class InterruptWatch {
public:
    InterruptWatch();
    ~InterruptWatch();
    InterruptWatch(const InterruptWatch&) = delete;
    InterruptWatch& operator=(const InterruptWatch&) = delete;

    int signal() const;        // 0: none yet
    bool takeRequest() const;  // whether SIGUSR1 has come since the last call
};

const char* getSignalName(int signal);
// The exit code of work that `signal` ended (0: nothing did). If one did, prints that, and `what` became of the work, to stderr.
ExitCode finish(int signal, const std::string& what);

}  // namespace glim
