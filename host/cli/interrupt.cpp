#include "host/cli/interrupt.hpp"

#include <csignal>

namespace glim {
namespace {

// A signal handler can reach nothing but a global.
volatile std::sig_atomic_t received = 0;

void remember(int signal)
{
    received = signal;
    std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptWatch::InterruptWatch()
{
    std::signal(SIGINT, remember);
    std::signal(SIGTERM, remember);
}

InterruptWatch::~InterruptWatch()
{
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

int InterruptWatch::signal() const { return received; }

}  // namespace glim
