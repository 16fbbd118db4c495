// What glim says, by ids and parts: sentences are for people and may be written better.
#pragma once

#include "host/error.hpp"
#include "host/json.hpp"
#include "tests/support/run_glim.hpp"

#include <gtest/gtest.h>

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace glim {

void PrintTo(const Message& message, std::ostream* stream);

namespace test {

// What a message must have. `file` is the end of its file, `expected` words of what it expects, and the others are equal; empty: any.
struct Parts {
    std::string file = {}, place = {}, value = {}, expected = {};
};

void expectMessage(const Message& message, MessageId id, const Parts& parts = {});

// Fails unless `step` throws an Error with such a message, of one line.
template <class Error, class Step>
void expectRefusal(Step step, MessageId id, const Parts& parts = {})
{
    try {
        step();
        ADD_FAILURE() << "nothing was refused, expected " << toText(id) << ' ' << parts.place;
    } catch (const Error& error) {
        expectMessage(error.message(), id, parts);
    }
}

// Of JSON with an id and parts, and with a sentence if it has one.
Message toMessage(const Json& json);

// What a process says to a program.
GlimRun runForMessages(GlimCall call);
GlimRun runForMessages(const std::vector<std::string>& arguments);

struct Said {
    std::string severity;  // "note", "warning", "error"
    Message message;
};
// The messages among the lines of stderr.
std::vector<Said> findMessages(const std::string& err);

// Of a run for messages: fails unless one with this id was said. The parts are of the first.
void expectSaid(const GlimRun& run, MessageId id, const Parts& parts = {});
bool hasSaid(const GlimRun& run, MessageId id);

// Of a run for messages that was refused: the exit code, one error as the only line of stderr, nothing on stdout.
void expectRefused(const GlimRun& run, int exitCode, MessageId id, const Parts& parts = {});

// The first with this id that a run for messages said.
std::optional<Message> findMessage(const GlimRun& run, MessageId id);

}  // namespace test
}  // namespace glim
