// The result of a command: its exit code and, if it was refused or failed, the reason.
#pragma once

#include "host/error.hpp"

#include <exception>
#include <functional>
#include <optional>
#include <string>

namespace glim {

struct Outcome {
    ExitCode code = ExitCode::Done;
    std::optional<Message> error = std::nullopt;  // nothing if nothing was thrown
};

// For a sentence.
std::string describeReason(const std::exception& error);

// Catches the errors that are not bugs in glim.
Outcome runForOutcome(const std::function<ExitCode()>& command);

}  // namespace glim
