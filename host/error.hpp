// Errors that are not bugs in glim: a bad file, a bad option, a failing driver. `main` prints the sentence and exits with the code.
#pragma once

#include "host/message.hpp"

#include <stdexcept>
#include <string>

namespace glim {

enum class ExitCode : int { Done = 0, BadInput = 1, Usage = 2, Device = 3, HungUp = 129, Interrupted = 130, Terminated = 143 };

// One sentence: which file, which place in it, which value, what was expected. It is escaped at once, since what() would end at a byte of
// 0.
class InputError : public std::runtime_error {
public:
    explicit InputError(const std::string& sentence)
        : std::runtime_error(escaped(sentence))
    {}
};

// A mistake in what was asked for: options and their values. One sentence without a full stop. `main` exits with ExitCode::Usage.
class UsageError : public std::runtime_error {
public:
    explicit UsageError(const std::string& sentence)
        : std::runtime_error(escaped(sentence))
    {}
    UsageError(const std::string& option, const std::string& why)
        : UsageError(option + ": " + why)
    {}
};

// One sentence: which device or driver call, what it answered, what was expected of it.
class DeviceError : public std::runtime_error {
public:
    explicit DeviceError(const std::string& sentence)
        : std::runtime_error(escaped(sentence))
    {}
};

}  // namespace glim
