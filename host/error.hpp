// Errors that are not bugs in glim: a bad file, a bad option, a failing driver. `main` prints the sentence and exits with the code.
#pragma once

#include "host/message.hpp"

#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>

namespace glim {

enum class ExitCode : int { Done = 0, BadInput = 1, Usage = 2, Device = 3, Differs = 4, HungUp = 129, Interrupted = 130, Terminated = 143 };

class Error : public std::runtime_error {
public:
    explicit Error(const Message& message)
        : std::runtime_error(message.sentence),
          message_(std::make_shared<const Message>(message))
    {}
    Error(MessageId id, std::initializer_list<MessagePart> words)
        : Error(Message(id, words))
    {}
    // What an error within a larger step says, with `words` around its sentence.
    Error(const Error& inner, std::initializer_list<MessagePart> words)
        : Error(Message(inner.message(), words))
    {}

    const Message& message() const { return *message_; }

private:
    std::shared_ptr<const Message> message_;  // shared, as a copy of an exception must not throw
};

// Which file, which place in it, which value, what was expected.
class InputError : public Error {
public:
    using Error::Error;
};

// A mistake in what was asked for: options and their values. The sentence has no full stop. `main` exits with ExitCode::Usage.
class UsageError : public Error {
public:
    using Error::Error;
};

// Which device or driver call, what it answered, what was expected of it.
class DeviceError : public Error {
public:
    using Error::Error;
};

}  // namespace glim
