// SIGINT, SIGTERM and SIGHUP as a question to ask between passes.
#pragma once

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

}  // namespace glim
