// What came of a command: its exit code and, if it was refused or failed, why.
#pragma once

#include "host/error.hpp"

#include <functional>
#include <string>

namespace glim {

struct Outcome {
    ExitCode code = ExitCode::Done;
    std::string error;  // one sentence; empty if nothing was thrown
};

// Catches the errors that are not bugs in glim.
Outcome outcomeOf(const std::function<ExitCode()>& command);

}  // namespace glim
