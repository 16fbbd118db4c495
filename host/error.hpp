// Errors that are not bugs in glim: a bad file, a bad option, a failing driver. `main` prints the sentence and exits with the code.
#pragma once

#include <stdexcept>
#include <string>

namespace glim {

enum class ExitCode : int { Done = 0, BadInput = 1, Usage = 2, Device = 3, HungUp = 129, Interrupted = 130, Terminated = 143 };

// One sentence: which file, which place in it, which value, what was expected.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// One sentence: which device or driver call, what it answered, what was expected of it.
class DeviceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace glim
