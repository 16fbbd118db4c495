#include "host/job/interrupt.hpp"

#include "host/message.hpp"

#include <csignal>

namespace glim {
namespace {

// A signal handler can reach nothing but a global.
volatile std::sig_atomic_t received = 0, requested = 0;

void noteSignal(int signal)
{
    received = signal;
    std::signal(signal, SIG_DFL);
}

void request(int) { requested = 1; }

// A signal that was ignored when glim started stays ignored, as nohup and scripts' background jobs ask.
void watch(int signal)
{
    if (std::signal(signal, noteSignal) == SIG_IGN) {
        std::signal(signal, SIG_IGN);
    }
}

void unwatch(int signal)
{
    if (std::signal(signal, SIG_DFL) == SIG_IGN) {
        std::signal(signal, SIG_IGN);
    }
}

}  // namespace

InterruptWatch::InterruptWatch()
{
    watch(SIGINT);
    watch(SIGTERM);
    watch(SIGHUP);
    std::signal(SIGPIPE, [](int) {});  // programs that glim starts do not inherit a handler
    std::signal(SIGUSR1, request);
}

InterruptWatch::~InterruptWatch()
{
    unwatch(SIGINT);
    unwatch(SIGTERM);
    unwatch(SIGHUP);
    std::signal(SIGUSR1, SIG_DFL);
}

bool InterruptWatch::takeRequest() const
{
    const bool was = requested != 0;
    requested = 0;
    return was;
}

int InterruptWatch::signal() const { return received; }

const char* getSignalName(int signal) { return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGHUP"; }

ExitCode finish(int signal, const std::string& what)
{
    if (signal == 0) {
        return ExitCode::Done;
    }
    say(MessageId::StoppedBySignal, {"stopped by ", part::value(getSignalName(signal)), "; ", what, "."});
    return signal == SIGINT ? ExitCode::Interrupted : signal == SIGTERM ? ExitCode::Terminated : ExitCode::HungUp;
}

}  // namespace glim
